import csv
import json

import pytest

from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import one_person, opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A recording file of sixteen emulated reaches."""
    path = tmp_path_factory.mktemp("recorded") / "reach.npz"
    assert opsim("motion", "sample", BENCH, "reach", "-n", 16, "--seed", 3, "-o", path)[0] == 0
    one_person(path)
    return path


@pytest.mark.slow
def test_all_tables_and_figures_of_the_paper_are_made(recorded, tmp_path):
    code, shown, progress = opsim("motion", "judge", recorded, "--paper", "-o", tmp_path / "out", "--json")
    assert code == 0 and "judge: reach: two levels" in progress
    made = {path.name for path in (tmp_path / "out" / "reach").iterdir()}
    assert made == {
        *(f"table_{n}.csv" for n in range(1, 6)),
        *(f"figure_{n}.svg" for n in (4, 5, 7, 8, 9, 10, 13, 14, 15, 16, 19)),
    }
    tables = json.loads(shown)["tables"]["reach"]
    assert [len(tables[f"table {n}"]) for n in range(1, 6)] == [3, 3, 2, 6, 6]
    rows = list(csv.reader((tmp_path / "out" / "reach" / "table_2.csv").open()))
    assert all(0 < float(p) <= 1 for row in rows[1:] for p in row[1:])
    assert "Figure 19" in (tmp_path / "out" / "index.html").read_text()


@pytest.mark.parametrize(
    "words, said",
    [
        (["missing.npz"], "no such file"),
        ([BENCH], "not a recording"),
    ],
)
def test_judge_refuses_what_it_cannot_use(tmp_path, words, said):
    code, _, complaint = opsim("motion", "judge", *words, "--paper", "-o", tmp_path / "out")
    assert code == 2 and said in complaint and not (tmp_path / "out").exists()


def test_all_that_is_wrong_is_said_at_once(recorded, tmp_path):
    code, _, complaint = opsim("motion", "judge", recorded, recorded, "missing.npz", "--paper", "-o", tmp_path / "out")
    assert code == 2 and "a second file of the task 'reach'" in complaint and "no such file" in complaint


def test_too_few_repetitions_are_refused(tmp_path):
    path = tmp_path / "few.npz"
    opsim("motion", "sample", BENCH, "reach", "-n", 5, "-o", path)
    code, _, complaint = opsim("motion", "judge", path, "--paper", "-o", tmp_path / "out")
    assert code == 2 and "found 5 repetitions, expected 12 or more" in complaint


def test_a_file_is_no_folder(recorded, tmp_path):
    (tmp_path / "out").write_text("")
    code, _, complaint = opsim("motion", "judge", recorded, "--paper", "-o", tmp_path / "out")
    assert code == 2 and "found a file, expected a folder" in complaint
