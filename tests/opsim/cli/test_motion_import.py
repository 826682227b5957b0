"""``opsim motion import``: files in, a recording and its picture out; mistakes all at once, nothing half written.

Inputs and outputs of ``opsim motion`` are tried before the work, and named when they are wrong.
"""

import json
import shutil
import warnings
from dataclasses import replace

import numpy as np
import pytest

import emulator
from emulator import MotionLibrary, read_motions
from emulator.recordings.bvh_write import write_bvh
from emulator.recordings.npz import read_recording
from opsim.shipped import shipped_folder
from tests.emulator.recordings.body import body, table_text, trc_text
from tests.opsim.cli.calls import opsim

TAKE = body(40, 50.0)
HEADER = ",".join(f"{name}_{axis}" for name in TAKE.names for axis in "xyz")


@pytest.fixture
def csv(tmp_path):
    """A maker of CSV files: ``csv("s01_e02.csv")``, the positions times ``by``."""

    def make(name, by=1000.0, places=TAKE.positions_m):
        path = tmp_path / name
        path.write_text(table_text([HEADER], by * places))
        return path

    return make


def imported(*words, drawn=False):
    """The call; its picture is drawn where that is asked for, and else an empty file."""
    with pytest.MonkeyPatch.context() as patch:
        if not drawn:
            patch.setattr("opsim.report.motion.importing.draw_import", lambda *_: b"")
        return opsim("motion", "import", *words)


def test_files_become_takes_of_one_recording(tmp_path, csv):
    out = tmp_path / "out.npz"
    code, said, err = imported(csv("s01_e01.csv"), csv("s01_e02.csv", 100.0), "-o", out, "--rate", 50, drawn=True)
    assert code == 0, err
    recording = read_recording(out)
    assert [take.name for take in recording.takes] == ["s01/e01", "s01/e02"]
    for take in recording.takes:
        assert np.allclose(take.positions_m, TAKE.positions_m, atol=1e-6) and take.rate_hz == 50.0
    assert "unit found from the body: cm" in said and "s01_e02.csv" in said and str(out) in said
    assert "import: s01_e02.csv: 2 of 2" in err
    assert (tmp_path / "out.import.svg").read_text().startswith("<?xml")


def test_what_is_imported_can_be_fitted_from(tmp_path, csv):
    out = tmp_path / "reach.npz"
    files = [csv(f"s0{k}_e01.csv") for k in range(1, 4)]
    assert imported(*files, "-o", out, "--rate", 50, "--source", "ours", "--licence", "MIT")[0] == 0
    motions = read_motions(out)
    assert (len(motions), motions.workers, motions.source, motions.licence) == (3, ("s01", "s02", "s03"), "ours", "MIT")


def test_the_same_files_give_the_same_bytes(tmp_path, csv):
    for out in ("a.npz", "b.npz"):
        assert imported(csv("s01_e01.csv"), "-o", tmp_path / out, "--rate", 50)[0] == 0
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()


def test_an_imported_recording_is_imported_again_as_it_is(tmp_path, csv):
    first, again = tmp_path / "a.npz", tmp_path / "b.npz"
    assert imported(csv("s01_e01.csv"), "-o", first, "--rate", 50, "--source", "ours", "--licence", "MIT")[0] == 0
    assert imported(first, "-o", again)[0] == 0
    one, other = read_recording(first), read_recording(again)
    assert np.array_equal(one.takes[0].positions_m, other.takes[0].positions_m)
    assert (other.source, other.licence, other.takes[0].name) == ("ours", "MIT", "s01/e01")


def test_json_for_machines(tmp_path, csv):
    code, said, _ = imported(
        csv("a.csv"), "-o", tmp_path / "out.npz", "--rate", 50, "--worker", "ana", "--trial", "7", "--json"
    )
    take = json.loads(said)["takes"][0]
    assert code == 0 and (take["take"], take["frames"], take["sides"], take["gap_share"]) == (
        "ana/7",
        40,
        "as named",
        0,
    )
    assert take["joints"] == list(TAKE.names)


def test_workers_and_trials_by_a_pattern(tmp_path, csv):
    files = [csv("HDM_bd_reach_001_50.csv"), csv("HDM_dg_reach_002_50.csv")]
    out = tmp_path / "out.npz"
    assert imported(*files, "-o", out, "--rate", 50, "--names", "HDM_{worker}_*_{trial}_*")[0] == 0
    assert [take.name for take in read_recording(out).takes] == ["bd/001", "dg/002"]
    code, _, err = imported(*files, "-o", out, "--rate", 50, "--names", "X_{worker}")
    assert code == 2 and err.count("the name does not fit --names") == 2
    assert imported(*files, "-o", out, "--rate", 50, "--names", "X_*")[0] == 2


def test_exchanged_sides_are_asked_for_and_mended(tmp_path, csv):
    mirrored = csv("m.csv", places=TAKE.positions_m * [1, -1, 1])
    out = tmp_path / "out.npz"
    code, _, err = imported(mirrored, "-o", out, "--rate", 50)
    assert code == 2 and "left and right are exchanged: by its toes" in err and "--sides mirror" in err
    assert not out.exists() and not (tmp_path / "out.import.svg").exists()
    assert imported(mirrored, "-o", out, "--rate", 50, "--sides", "mirror")[0] == 0
    assert np.allclose(read_recording(out).takes[0].positions_m, TAKE.positions_m, atol=1e-6)


def test_a_mapping_file_names_what_is_not_known(tmp_path, csv):
    path = tmp_path / "a.csv"
    path.write_text(table_text([HEADER.replace("left_hip", "bone7")], TAKE.positions_m))
    out = tmp_path / "out.npz"
    code, _, err = imported(path, "-o", out, "--rate", 50)
    assert code == 2 and "found no pelvis" not in err and "found no left_hip" in err and "'bone7'" in err
    names = tmp_path / "names.txt"
    names.write_text("bone7: left_hip\n")
    assert imported(path, "-o", out, "--rate", 50, "--map", names)[0] == 0


def test_unknown_joints_are_said_with_the_nearest(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(table_text([HEADER.replace("left_hand", "left_hnad")], TAKE.positions_m))
    code, said, _ = imported(path, "-o", tmp_path / "out.npz", "--rate", 50)
    assert code == 0 and "not known: left_hnad (nearest: left_hand)" in said


def test_all_mistakes_of_all_options_are_said_at_once(tmp_path, csv):
    file = csv("a.csv")
    code, _, err = imported(
        file, file, "-o", tmp_path / "out.csv", "--unit", "mile", "--up", "w", "--rate", "fast", "--min-score", 7,
        "--sides", "both", "--trial", "1", "--worker", " ", "--map", "no.txt", "--asf", "no.asf", "--picture", "a.gif",
    )  # fmt: skip
    assert code == 2
    for word in ("out.csv", "--unit", "--up", "--rate", "--min-score", "--sides", "--trial", "--worker", "--picture"):
        assert word in err, word


def test_the_mistakes_of_all_files_are_said_and_nothing_is_written(tmp_path, csv):
    (tmp_path / "b.trc").write_text("nothing")
    (tmp_path / "c.bvh").write_text("nothing")
    out = tmp_path / "new" / "out.npz"
    code, _, err = imported(csv("s01_e01.csv"), tmp_path / "b.trc", tmp_path / "c.bvh", tmp_path / "d.xyz", "-o", out)
    assert code == 2 and not out.parent.exists()
    for name in ("s01_e01.csv", "b.trc", "c.bvh", "d.xyz"):
        assert name in err


def test_takes_that_do_not_go_together_are_refused(tmp_path, csv):
    other = tmp_path / "s01_e03.trc"
    other.write_text(trc_text(TAKE.names[:-1], 1000 * TAKE.positions_m[:, :-1]))
    code, _, err = imported(csv("s01_e01.csv"), other, "-o", tmp_path / "out.npz")
    assert code == 2 and "--rate" in err
    path = tmp_path / "s01_e04.csv"
    path.write_text(table_text(["time," + HEADER], TAKE.positions_m, first=np.arange(40) / 50))
    code, _, err = imported(path, other, "-o", tmp_path / "out.npz")
    assert code == 2 and "s01_e03.trc: found no right_toe, expected the joints of" in err
    assert "found 100 frames a second, expected 50" in err
    copy = tmp_path / "sub" / "s01_e04.csv"
    copy.parent.mkdir()
    copy.write_text(path.read_text())
    code, _, err = imported(path, copy, "-o", tmp_path / "out.npz")
    assert code == 2 and "both are called s01/e04" in err


def test_the_file_that_is_read_is_not_overwritten(tmp_path, csv):
    out = tmp_path / "a.npz"
    assert imported(csv("a.csv"), "-o", out, "--rate", 50)[0] == 0
    before = out.read_bytes()
    code, _, err = imported(out, "-o", out)
    assert code == 2 and "is read, expected another file" in err and out.read_bytes() == before


def test_gaps_are_counted_and_drawn(tmp_path, csv):
    holes = TAKE.positions_m.copy()
    holes[5:15, TAKE.names.index("left_hand")] = np.nan
    code, said, _ = imported(csv("a.csv", places=holes), "-o", tmp_path / "o.npz", "--rate", 50, "--json", drawn=True)
    assert code == 0 and json.loads(said)["takes"][0]["gap_share"] == pytest.approx(10 / 40 / 21)


def test_one_frame_is_said_together_with_the_mistakes_of_the_other_files(tmp_path):
    write_bvh(replace(TAKE, positions_m=TAKE.positions_m[:1]), tmp_path / "one.bvh")
    code, _, err = imported(tmp_path / "one.bvh", tmp_path / "no.bvh", "-o", tmp_path / "o.npz")
    assert code == 2 and f"{tmp_path / 'one.bvh'}: found 1 frame, expected 2 or more" in err
    assert "no.bvh: no such file" in err


def test_joints_that_are_left_out_are_named(tmp_path):
    extra = ["left_eye", "right_eye", "left_ear", "right_ear", "nose", "odd1", "odd2"]
    header = ",".join([HEADER, *(f"{name}_{axis}" for name in extra for axis in "xyz")])
    head = TAKE.positions_m[:, [TAKE.names.index("head")] * len(extra)]
    (tmp_path / "a.csv").write_text(table_text([header], np.concatenate([TAKE.positions_m, head], axis=1)))
    code, said, err = imported(tmp_path / "a.csv", "-o", tmp_path / "o.npz", "--rate", 50)
    assert code == 0, err
    assert "5 left out [left_eye, right_eye, left_ear, right_ear, nose]" in said and "2 unknown [odd1, odd2]" in said


def test_a_file_is_given_once(tmp_path, csv):
    file = csv("s01_e01.csv")
    code, _, err = imported(file, tmp_path / "." / "sub" / ".." / file.name, "-o", tmp_path / "o.npz", "--rate", 50)
    assert code == 2 and f"{file}: found as file 1 and 2, expected each file once" in err


def test_letters_without_a_glyph_and_folders_for_files_are_no_noise(tmp_path, csv):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        code, _, err = imported(csv("日本.csv"), "-o", tmp_path / "o.npz", "--rate", 50, drawn=True)
    assert code == 0 and "Warning" not in err
    (tmp_path / "d.npz").mkdir()
    code, _, err = imported(tmp_path / "nosuch.csv", "-o", tmp_path / "d.npz", "--names", "{foo}_{worker", "--up", "w")
    assert code == 2 and "d.npz: found a folder, expected the name of a file" in err and "nosuch" not in err
    assert "--names: found '{foo}', '{worker'" in err and "--up: found 'w'" in err


def test_the_body_is_measured_for_every_file(tmp_path, csv):
    code, said, _ = imported(csv("a.csv"), "-o", tmp_path / "o.npz", "--rate", 50, "--unit", "mm")
    assert code == 0 and "1.52 m" in said and "body: from head to feet it is 1.52 m" in said
    code, _, err = imported(csv("a.csv"), "-o", tmp_path / "o.npz", "--rate", 50, "--unit", "m")
    assert code == 2 and "give --unit mm" in err


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
        ("zzz", "shipped ones: bench_work, handling, public_movements, reach.npz"),
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
