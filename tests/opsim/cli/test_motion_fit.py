"""``opsim motion fit``: every mistake at once, and no finished task is lost when another one fails or is stopped."""

import shutil

import pytest

from emulator import MotionEmulator, MotionLibrary
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"
QUICK = ("--n-components", 2, "--n-times", 21)


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A folder with the same six reaches as recordings of the tasks a, b and c."""
    folder = tmp_path_factory.mktemp("recorded")
    assert opsim("motion", "sample", BENCH, "reach", "-n", 6, "--fps", 20, "-o", folder / "a.npz")[0] == 0
    for task in "bc":
        shutil.copy(folder / "a.npz", folder / f"{task}.npz")
    return folder


def fails(monkeypatch, task, error):
    """A fit of ``task`` raises ``error``; others are as ever."""
    true = MotionEmulator.fit

    def fit(motions, **how):
        if motions.task == task:
            raise error
        return true(motions, **how)

    monkeypatch.setattr(MotionEmulator, "fit", fit)


def fitted(recorded, out):
    return opsim("motion", "fit", *(recorded / f"{task}.npz" for task in "abc"), "-o", out, *QUICK)


def test_ctrl_c_keeps_the_finished_tasks_and_says_which_are_missing(recorded, tmp_path, monkeypatch):
    fails(monkeypatch, "b", KeyboardInterrupt())
    out = tmp_path / "new" / "lib.npz"
    code, _, complaint = fitted(recorded, out)
    assert code == 130 and complaint.splitlines()[-1] == f"stopped; {out} holds a, not b, c"
    assert MotionLibrary.load(out).tasks == ("a",)


def test_a_task_that_fails_takes_nothing_from_the_others(recorded, tmp_path, monkeypatch):
    fails(monkeypatch, "b", ValueError("b: something odd"))
    out = tmp_path / "lib.npz"
    code, shown, complaint = fitted(recorded, out)
    assert code == 2 and complaint.splitlines()[-2:] == ["b: something odd", f"{out} holds a, c, not b"]
    assert MotionLibrary.load(out).tasks == ("a", "c") and "library: " in shown


def test_a_mistake_of_ours_keeps_the_finished_tasks_too(recorded, tmp_path, monkeypatch):
    fails(monkeypatch, "c", ZeroDivisionError("ours"))
    with pytest.raises(AssertionError, match="ours"):
        fitted(recorded, tmp_path / "lib.npz")
    assert MotionLibrary.load(tmp_path / "lib.npz").tasks == ("a", "b")


@pytest.mark.parametrize(
    "error, code, said",
    [(KeyboardInterrupt(), 130, "stopped; nothing was finished"), (ValueError("odd"), 2, "a: odd")],
)
def test_where_nothing_was_finished_no_file_and_no_folder_are_left(recorded, tmp_path, monkeypatch, error, code, said):
    fails(monkeypatch, "a", error)
    found, _, complaint = opsim("motion", "fit", recorded / "a.npz", "-o", tmp_path / "new" / "deep" / "l.npz", *QUICK)
    assert found == code and complaint.splitlines()[-1] == said and list(tmp_path.iterdir()) == []


def test_all_that_is_wrong_with_the_options_is_said_at_once(recorded, tmp_path):
    words = ("--n-components", "nan", "--landmarks", "nan", "--scheme", "autp", "-o", tmp_path / "lx.txt")
    code, _, complaint = opsim("motion", "fit", recorded / "a.npz", "missing.npz", *words)
    assert code == 2 and complaint.splitlines() == [
        f"{tmp_path / 'lx.txt'}: found the ending '.txt', but a library ends in .npz",
        "--n-components: found 'nan', expected a whole number from 1 or a share of variance such as 0.98",
        "scheme: no 'autp'; did you mean 'auto'?",
        "--landmarks: found 'nan', expected a number from 0 to 1",
        "missing.npz: no such file",
    ]


@pytest.mark.parametrize("words", [("--landmarks", "1.5"), ("--landmarks", "inf"), ("--scheme", "")])
def test_a_setting_out_of_range_is_refused(recorded, tmp_path, words):
    code, _, complaint = opsim("motion", "fit", recorded / "a.npz", "-o", tmp_path / "l.npz", *words)
    assert code == 2 and f"{words[0].removeprefix('--')}: " in complaint and f"{words[1]!r}" in complaint
