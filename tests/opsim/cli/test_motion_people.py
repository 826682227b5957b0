"""``opsim motion people``: what is printed and written, what is kept when something fails, and what it refuses."""

import csv
import json

import numpy as np
import pytest

from emulator.fitting.settings import FitSettings
from emulator.judge import people
from emulator.model.emulator import SCHEME
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"
WRITTEN = {"people.csv", "left_out.csv", "icc.csv", "covariates.csv", "people.svg", "index.html"}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """Recordings of four people, two emulated reaches and lifts each, with a covariate; their folder."""
    folder = tmp_path_factory.mktemp("recorded")
    for task in ("reach", "lift"):
        path = folder / f"{task}.npz"
        assert opsim("motion", "sample", BENCH, task, "-n", 8, "--fps", 25, "--seed", 3, "-o", path)[0] == 0
        named(path, path.name, subject=np.repeat(["a", "b", "c", "d"], 2), cov_grip=np.repeat([1.0, 2.0, 4.0, 7.0], 2))
    return folder


@pytest.fixture(autouse=True)
def quick(monkeypatch):
    """A coarser clock than a user's: what is printed is tested, not what is found."""
    monkeypatch.setattr(people, "usual_settings", lambda seed: FitSettings(SCHEME, None, 21, 8, 0.0, seed, ""))


def named(path, name, **changes):
    """A copy of the file under another name, with some arrays changed."""
    with np.load(path) as file:
        arrays = {**file, **changes}
    np.savez(path.parent / name, **arrays)
    return path.parent / name


def fails_at_the_second(error):
    """``people_of`` for one task only."""
    true, asked = people.people_of, []

    def people_of(motions, *rest):
        asked.append(motions.task)
        if len(asked) > 1:
            raise error
        return true(motions, *rest)

    return people_of


def rows_of(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.slow
def test_tables_are_printed_and_written(recorded, tmp_path):
    out = tmp_path / "out"
    code, shown, progress = opsim("motion", "people", recorded / "reach.npz", recorded / "lift.npz", "-o", out)
    assert code == 0 and {path.name for path in out.iterdir()} == WRITTEN
    assert "reach: 8 repetitions of 4 people" in shown and "R2 grip (p)" in shown and "log duration" in shown
    assert "people: 0 of 26" in progress and "people: 26 of 26" in progress
    found = rows_of(out / "people.csv")
    closer = sum(row["own_closer"] == "yes" for row in found)
    assert [row["task"] for row in found] == ["reach"] * 4 + ["lift"] * 4
    assert f"for {closer} of 8 (task, worker) pairs" in shown and f"page: {out / 'index.html'}" in shown
    assert len(rows_of(out / "left_out.csv")) == 16


@pytest.mark.slow
def test_json_says_the_same_and_the_seed_decides(recorded, tmp_path):
    def of(seed):
        words = ("motion", "people", recorded / "reach.npz", "-o", tmp_path / str(seed), "--seed", seed, "--json")
        return json.loads(opsim(*words)[1])

    one, other = of(1), of(2)
    rows = rows_of(tmp_path / "1" / "left_out.csv")
    assert [float(row["known_sum"]) for row in rows] == [row["known_sum"] for row in one["tasks"]["reach"]["left_out"]]
    assert one["pairs"]["judged"] == 4 and one["page"].endswith("index.html")
    assert one["tasks"]["reach"]["icc"] == other["tasks"]["reach"]["icc"]
    assert one["tasks"]["reach"]["left_out"] != other["tasks"]["reach"]["left_out"]


@pytest.mark.slow
def test_a_task_that_fails_takes_nothing_from_the_others(recorded, tmp_path, monkeypatch):
    monkeypatch.setattr(people, "people_of", fails_at_the_second(ValueError("lift: something odd")))
    files = recorded / "reach.npz", recorded / "lift.npz"
    code, shown, complaint = opsim("motion", "people", *files, "-o", tmp_path / "out")
    assert code == 2 and complaint.strip().endswith("lift: something odd") and "reach: 8 repetitions" in shown
    assert {path.name for path in (tmp_path / "out").iterdir()} == WRITTEN
    assert {row["task"] for row in rows_of(tmp_path / "out" / "people.csv")} == {"reach"}


@pytest.mark.slow
def test_what_was_done_before_ctrl_c_is_kept_and_it_says_so(recorded, tmp_path, monkeypatch):
    monkeypatch.setattr(people, "people_of", fails_at_the_second(KeyboardInterrupt()))
    files = recorded / "reach.npz", recorded / "lift.npz"
    code, _, complaint = opsim("motion", "people", *files, "-o", tmp_path / "out")
    assert code == 130 and f"stopped; 1 of 2 tasks are in {tmp_path / 'out' / 'index.html'}" in complaint
    assert {path.name for path in (tmp_path / "out").iterdir()} == WRITTEN


def test_all_that_is_wrong_is_said_at_once_before_anything_is_made(recorded, tmp_path, monkeypatch):
    monkeypatch.setattr(people, "people_of", lambda *_: pytest.fail("it was begun"))
    reach = recorded / "reach.npz"
    alone = named(reach, "alone.npz", subject=np.repeat("a", 8))
    (tmp_path / "out").write_text("")
    code, _, complaint = opsim(
        "motion", "people", reach, reach, alone, "missing.npz", "-o", tmp_path / "out", "--where", "cov_grip<4"
    )
    assert code == 2 and complaint.splitlines() == [
        f"{reach}: a second file of the task 'reach'",
        "alone: found one worker (a), expected two or more to tell apart",
        "missing.npz: no such file",
        f"{tmp_path / 'out'}: found a file, expected a folder to write into",
    ]


def test_too_few_repetitions_are_refused_and_no_folder_is_made(recorded, tmp_path):
    where = ("--where", "trial in (k0, k1)")
    code, _, complaint = opsim("motion", "people", recorded / "reach.npz", "-o", tmp_path / "out", *where)
    assert code == 2 and "reach: found 2 repetitions, expected 4 or more" in complaint
    assert "found one worker (a)" in complaint and not (tmp_path / "out").exists()
