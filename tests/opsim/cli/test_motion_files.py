"""Inputs and outputs of ``opsim motion`` are tried before the work, and named when they are wrong."""

import re
import shutil

import numpy as np
import pytest

import emulator
from emulator import MotionLibrary
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def made_reach(tmp_path_factory):
    path = tmp_path_factory.mktemp("made") / "reach.npz"
    assert opsim("motion", "sample", BENCH, "reach", "-n", 6, "--fps", 20, "-o", path)[0] == 0
    return path


@pytest.fixture
def folder(made_reach, tmp_path, monkeypatch):
    """A folder to stand in, with a recording of six reaches in it, where no fit may begin."""
    shutil.copy(made_reach, tmp_path / "reach.npz")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(emulator.MotionEmulator, "fit", lambda *_, **__: pytest.fail("the fit began"))
    return tmp_path


def changed(name, **changes):
    with np.load("reach.npz") as file:
        np.savez(name, **{**file, **changes})
    return name


@pytest.mark.parametrize(
    "words, said",
    [
        (["-o", "folder.npz"], "folder.npz: found a folder, expected the name of a file"),
        (["-o", "reach.npz/lib.npz"], "reach.npz/lib.npz: cannot be written: reach.npz is, or lies in, a file"),
        (["other/reach.npz", "-o", "l.npz"], "both reach.npz and other/reach.npz give the task 'reach'"),
        (["other/reach.npz", "-o", "l.npz", "--task", "x"], "--task x: found 2 files, expected one"),
        (["-o", "l.npz", "--task", "a/b"], "--task: found 'a/b', expected a name without '/'"),
        (["-o", "l.npz", "--task", " "], "--task: found ' '"),
        (["-o", "l.npz", "--n-components", "nan"], "expected a whole number from 1 or a share of variance"),
        (["-o", "l.npz", "--n-components", "inf"], "found 'inf'"),
        (["-o", "l.npz", "--n-components", "6"], "reach.npz: --n-components: found 6, expected at most 5"),
        (["-o", "l.npz", "--where", "trial == k1"], "reach.npz: found 1 repetition, expected 3 or more"),
        (["-o", "l.npz", "--where", "(" * 3000 + "trial == k1"], "nest deeper than"),
    ],
)
def test_what_speaks_against_a_fit_is_said_before_it_begins(folder, words, said):
    (folder / "other").mkdir()
    (folder / "folder.npz").mkdir()
    shutil.copy("reach.npz", "other/reach.npz")
    code, _, complaint = opsim("motion", "fit", "reach.npz", *words)
    assert code == 2 and said in complaint


def test_the_mistakes_of_all_files_are_said_at_once(folder):
    files = [changed("a.npz", fps=np.nan), changed("b.npz", offsets=np.array([])), "missing.npz"]
    code, _, complaint = opsim("motion", "fit", *files, "-o", "l.npz")
    assert code == 2
    assert [line.split(":")[0] for line in complaint.splitlines()] == ["a.npz", "b.npz", "missing.npz"]


def test_a_folder_that_may_not_be_written_is_found_before_the_fit(folder, monkeypatch):
    def refuse(**_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    code, _, complaint = opsim("motion", "fit", "reach.npz", "-o", "l.npz")
    assert code == 2 and complaint.strip() == "l.npz: cannot be written: Permission denied"


@pytest.mark.parametrize("verb", ["sample", "show"])
@pytest.mark.parametrize(
    "library, said",
    [
        ("public_movement", "no library 'public_movement'; did you mean 'public_movements'?"),
        ("bench_wrok.npz", "did you mean 'bench_work'?"),
        ("raech.npz", "did you mean 'reach.npz'?"),
        ("zzz", "shipped ones: bench_work, public_movements, reach.npz"),
    ],
)
def test_a_mistyped_library_gets_the_nearest_word(folder, verb, library, said):
    code, _, complaint = opsim("motion", verb, library, "reach")
    assert code == 2 and said in complaint


@pytest.mark.parametrize("fps", ["nan", "inf", "0"])
def test_an_impossible_rate_is_said(folder, fps):
    code, _, complaint = opsim("motion", "sample", BENCH, "reach", "--fps", fps)
    assert code == 2 and "--fps" in complaint and fps in complaint


def test_show_makes_the_folder_it_draws_into(folder):
    assert opsim("motion", "show", BENCH, "reach", "-n", 1, "-o", "new/z.png")[0] == 0
    assert (folder / "new/z.png").read_bytes().startswith(b"\x89PNG")


def test_show_and_sample_refuse_a_folder_as_their_file(folder):
    for verb, name in (("show", "x.png"), ("sample", "x.csv")):
        (folder / name).mkdir()
        code, _, complaint = opsim("motion", verb, BENCH, "reach", "-o", name)
        assert code == 2 and f"{name}: found a folder" in complaint


def test_a_task_can_be_named_and_the_library_says_so(made_reach, tmp_path):
    out = tmp_path / "lib.npz"
    assert opsim("motion", "fit", made_reach, "-o", out, "--task", "grab it")[0] == 0
    library = MotionLibrary.load(out)
    assert library.tasks == ("grab it",)
    assert library.command == "opsim motion fit reach.npz -o lib.npz --task 'grab it'"


def test_one_repetition_six_times_is_fitted_with_one_clear_note(made_reach, tmp_path):
    with np.load(made_reach) as file:
        n = file["offsets"][1]
        same = {"positions": np.tile(file["positions"][:n], (6, 1, 1)), "offsets": np.arange(7) * n}
        marks = {key: np.repeat(file[key][:1], 6) for key in file.files if key.startswith("ann_")}
        np.savez(tmp_path / "same.npz", **{**file, **same, **marks})
    code, shown, _ = opsim("motion", "fit", tmp_path / "same.npz", "-o", tmp_path / "lib.npz")
    assert code == 0 and "nan" not in shown and shown.count("one and the same movement") == 1


@pytest.mark.slow
def test_the_motion_commands_of_the_docs_work_one_after_the_other(tmp_path, monkeypatch):
    page = (shipped_folder().parent / "docs" / "motion.md").read_text(encoding="utf-8")
    lines = [line.partition("#")[0] for line in page.splitlines() if re.match("opsim motion .*squat", line)]
    monkeypatch.chdir(tmp_path)
    opsim("motion", "sample", "public_movements", "deep_squat", "-n", 8, "-o", "reach.npz")
    changed("deep_squat.npz", cov_correct=np.ones(8, int))
    assert len(lines) == 9
    verbs = ("fit", "sample", "show")  # judging takes a minute: see test_motion_judge, test_motion_people
    for line in (line for line in lines if line.split()[2] in verbs):
        code, _, complaint = opsim(*line.replace('"', "").split()[1:])
        assert code == 0, complaint
    assert {"lib.npz", "drawn.npz", "strip.png", "squat.gif"} <= {path.name for path in tmp_path.iterdir()}
