import json

import pytest

from emulator.judge.paper import Table
from opsim.cli.motion import judge as judging
from opsim.report.motion.emulator_paper import Section
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


def test_json_has_the_page_and_the_rows_of_each_table(recorded, tmp_path, monkeypatch):
    """Of a made section; all true tables and figures come of a command of docs/motion.md (tests/test_readme.py)."""
    table = Table(2, "made", ("test", "p"), (("first", 0.5), ("second", 0.25)))
    monkeypatch.setattr(judging, "sections", lambda sets, seed: iter([Section(sets[0].task, "made", (table,))]))
    code, shown, _ = opsim("motion", "judge", recorded, "--paper", "-o", tmp_path / "out", "--json")
    assert code == 0 and json.loads(shown) == {
        "page": str(tmp_path / "out" / "index.html"),
        "tables": {"reach": {"table 2": [["first", 0.5], ["second", 0.25]]}},
    }


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
