"""What ``opsim motion judge`` keeps when it is stopped or fails, with and without --paper; nothing empty is left."""

import shutil

import pytest

from emulator.judge import held_out_table
from opsim.cli.motion import judge as judging
from opsim.report.motion.emulator_paper import Section
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import one_person, opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """The same twelve movements of one person as two recordings: the tasks a and b."""
    folder = tmp_path_factory.mktemp("recorded")
    assert opsim("motion", "sample", BENCH, "reach", "-n", 12, "--fps", 20, "-o", folder / "a.npz")[0] == 0
    one_person(folder / "a.npz")
    shutil.copy(folder / "a.npz", folder / "b.npz")
    return folder / "a.npz", folder / "b.npz"


def classes(error):
    """Sections of the first class only, in no time; then ``error``, if there is one."""

    def sections(sets, seed):
        for place, motions in enumerate(sets):
            yield f"{motions.task}: fitting"
            if error is not None and place == len(sets) - 1:
                raise error
            yield Section(motions.task, "made")

    return sections


@pytest.mark.parametrize(
    "error, code, said", [(KeyboardInterrupt(), 130, "stopped; "), (ValueError("b: odd"), 2, "b: odd\n")]
)
def test_finished_classes_of_the_paper_are_kept_and_named(recorded, tmp_path, monkeypatch, error, code, said):
    monkeypatch.setattr(judging, "sections", classes(error))
    out = tmp_path / "out"
    found, _, complaint = opsim("motion", "judge", *recorded, "--paper", "-o", out)
    assert found == code and complaint.endswith(f"{said}{out} holds a, not b\n")
    page = (out / "index.html").read_text(encoding="utf-8")
    assert "a: 12 repetitions" in page and "b: 12 repetitions" not in page


def test_steps_of_the_paper_count_as_done_when_the_next_begins(recorded, tmp_path, monkeypatch):
    monkeypatch.setattr(judging, "sections", classes(None))
    _, _, progress = opsim("motion", "judge", *recorded, "--paper", "-o", tmp_path / "out")
    lines = [line.partition(",")[0] for line in progress.splitlines()]
    assert lines == ["judge: a: fitting: 0 of 11", "judge: b: fitting: 1 of 11", "judge: done: 11 of 11"]


@pytest.mark.parametrize("paper", [["--paper"], []])
@pytest.mark.parametrize(
    "error, code, said", [(KeyboardInterrupt(), 130, "stopped; nothing was finished"), (ValueError("odd"), 2, "odd")]
)
def test_one_file_stopped_leaves_no_empty_folder(recorded, tmp_path, monkeypatch, paper, error, code, said):
    def judge(*_):
        raise error

    monkeypatch.setattr(judging, "sections", classes(error))
    monkeypatch.setattr(held_out_table, "judge_held_out", judge)
    found, _, complaint = opsim("motion", "judge", recorded[0], *paper, "-o", tmp_path / "new" / "out")
    assert found == code and complaint.splitlines()[-1].endswith(said) and list(tmp_path.iterdir()) == []


def test_ctrl_c_at_the_second_file_keeps_the_table_of_the_first(recorded, tmp_path, monkeypatch):
    true = held_out_table.judge_held_out

    def judge(motions, *rest):
        if motions.task == "b":
            raise KeyboardInterrupt
        return true(motions, *rest, n_times=21, n_drawn=20)

    monkeypatch.setattr(held_out_table, "judge_held_out", judge)
    out = tmp_path / "judged.csv"
    words = ("--splits", 1, "--scheme", "PWI")
    code, shown, complaint = opsim("motion", "judge", *recorded, *words, "-o", out)
    assert code == 130 and complaint.splitlines()[-1] == f"stopped; {out} holds a, not b"
    assert "a: 12 repetitions" in shown and ",PWI," in out.read_text(encoding="utf-8")


@pytest.mark.parametrize("verb", [["judge", "--paper"], ["people"]])
def test_a_folder_is_not_named_like_a_file(recorded, tmp_path, verb):
    code, _, complaint = opsim("motion", *verb, recorded[0], "-o", tmp_path / "x.csv")
    assert code == 2 and "x.csv: found the ending '.csv' of a file, expected a folder" in complaint
    assert list(tmp_path.iterdir()) == []
