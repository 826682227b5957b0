"""What is asked of ``opsim motion show`` and does not go together: every mistake at once, and nothing is written.

``opsim motion sample -o x.bvh``: drawn performances for programs of animation.

No verb of ``opsim motion`` writes over what it reads, nor a library over a recording or the other way round.
"""

import csv
import json
import shutil

import numpy as np
import pytest

import emulator
from emulator import MotionLibrary, read_motions
from emulator.recordings.bvh import read_bvh
from emulator.recordings.npz import read_recording
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import one_person, opsim
from tests.recordings import recording

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def emulated(tmp_path_factory):
    """A recording file of twelve emulated reaches."""
    path = tmp_path_factory.mktemp("emulated") / "reach.npz"
    assert opsim("motion", "sample", BENCH, "reach", "-n", 12, "--seed", 3, "-o", path)[0] == 0
    one_person(path)
    return path


def test_sampled_movements_are_recordings_again(emulated):
    drawn = MotionLibrary.load(BENCH)["reach"].sample(12, np.random.default_rng(3))
    motions = read_motions(emulated, where=None)
    assert len(motions.motions) == 12 and "emulated by opsim motion sample" in motions.source
    assert np.abs(motions.duration_s - drawn.duration_s).max() <= 0.5 / 50 + 1e-9
    assert motions.mark_names == MotionLibrary.load(BENCH)["reach"].mark_names


def test_each_drawn_performance_is_of_another_new_person(tmp_path):
    out = tmp_path / "reach.npz"
    assert opsim("motion", "sample", BENCH, "reach", "-n", 6, "--fps", 20, "-o", out)[0] == 0
    assert read_motions(out, where=None).workers == tuple(f"new{k}" for k in range(1, 7))
    assert opsim("motion", "fit", out, "-o", tmp_path / "lib.npz", "--n-times", 21)[0] == 0
    assert MotionLibrary.load(tmp_path / "lib.npz")["reach"].report.n_workers == 6


def test_new_people_may_have_several_performances_each_of_a_library_and_task_in_one_word(tmp_path):
    out = tmp_path / "reach.npz"
    words = ("-n", 5, "--new-people", 2, "--fps", 20, "-o", out)
    assert opsim("motion", "sample", "bench_work/reach", *words)[0] == 0
    motions = read_motions(out, where=None).motions
    assert [motion.worker for motion in motions] == ["new1", "new1", "new1", "new2", "new2"]
    sizes_m = np.array([motion.bone_length_m.sum() for motion in motions])
    assert np.ptp(sizes_m[:3]) < 0.001 * sizes_m[0] < abs(sizes_m[3] - sizes_m[0])


def test_those_of_one_person_of_the_fit_have_the_name_and_that_persons_ways(tmp_path):
    model = MotionLibrary.load(BENCH)["reach"]
    name, out = model.workers[0], tmp_path / "reach.npz"
    words = ("-n", 4, "--fps", 20, "--person", name, "-o", out, "--json")
    code, shown, _ = opsim("motion", "sample", BENCH, "reach", *words)
    mine = model.sample(4, np.random.default_rng(0), worker=name).duration_s
    assert code == 0 and [row["duration_s"] for row in json.loads(shown)["performances"]] == list(mine)
    assert read_motions(out, where=None).workers == (name,)


def test_an_unknown_person_is_refused(tmp_path):
    out = tmp_path / "x.npz"
    code, _, complaint = opsim("motion", "sample", BENCH, "reach", "--person", "nobody", "-o", out)
    assert code == 2 and "no worker 'nobody'" in complaint and not out.exists()


def test_fit_prints_what_it_found_and_writes_the_library(emulated, tmp_path):
    out = tmp_path / "lib.npz"
    code, shown, progress = opsim("motion", "fit", emulated, "-o", out, "--where", "all", "--n-times", 31)
    assert code == 0 and "12 of 1 workers" in shown and "ICC of log duration" in shown and "not estimable" in shown
    assert "fit reach: aligning" in progress
    library = MotionLibrary.load(out)
    assert library.command == "opsim motion fit reach.npz -o lib.npz --where 'all' --n-times 31" and library.tasks == (
        "reach",
    )


def test_fit_as_json_is_json(emulated, tmp_path):
    words = ("-o", tmp_path / "lib.npz", "--n-components", 3, "--n-times", 31, "--json")
    code, shown, _ = opsim("motion", "fit", emulated, *words)
    assert code == 0 and json.loads(shown)["tasks"]["reach"]["n_components"] == 3


def test_fit_takes_a_scheme_a_clock_and_landmarks_and_keeps_the_command(emulated, tmp_path):
    out = tmp_path / "lib.npz"
    asked = ("--scheme", "SIEM/JointPCA/MVG", "--n-times", 51, "--landmarks", 0.01)
    code, _, _ = opsim("motion", "fit", emulated, "-o", out, *asked)
    model = MotionLibrary.load(out)["reach"]
    assert code == 0 and (model.report.scheme, model.n_times) == ("SIEM/JointPCA/MVG", 51)
    assert "strength 0.01" in model.report.methods["landmarks"]
    said = "--scheme SIEM/JointPCA/MVG --n-times 51 --landmarks 0.01"
    assert model.report.command == f"opsim motion fit reach.npz -o lib.npz {said}"


@pytest.mark.slow
def test_a_recorded_task_is_fitted_with_its_six_people(tmp_path):
    words = ("-o", tmp_path / "lib.npz", "--n-components", 3, "--n-times", 31, "--json")
    code, shown, _ = opsim("motion", "fit", recording("uiprmd_deep_squat"), *words)
    report = json.loads(shown)["tasks"]["deep_squat"]
    assert (code, report["n_sequences"], report["n_workers"]) == (0, 41, 6)


@pytest.mark.parametrize(
    "words, said",
    [
        (["missing.npz", "-o", "lib.npz"], "no such file"),
        ([__file__, "-o", "lib.npz"], "end in .npz"),
        ([BENCH, "-o", "lib.npz"], "not a recording"),
        ([BENCH, "-o", "lib.txt"], "ends in .npz"),
        ([BENCH], "--out"),
        ([BENCH, "-o", "lib.npz", "--n-components", "0.0"], "share of variance"),
        ([BENCH, "-o", "lib.npz", "--scheme", "SIEM/JointPCA/MVF"], "did you mean 'SIEM/JointPCA/MVG'?"),
        ([BENCH, "-o", "lib.npz", "--n-times", "3"], "10<=x<=2001"),
        ([BENCH, "-o", "lib.npz", "--n-components", "2.5"], "share of variance"),
    ],
)
def test_fit_refuses_what_it_cannot_use(tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("motion", "fit", *words)
    assert code == 2 and said in complaint and not (tmp_path / "lib.npz").exists()


def test_a_mistyped_covariate_gets_the_nearest_word(tmp_path):
    code, _, complaint = opsim(
        "motion", "fit", recording("uiprmd_deep_squat"), "-o", tmp_path / "l.npz", "--where", "cov_corect==1"
    )
    assert code == 2 and "did you mean 'cov_correct'?" in complaint


def test_samples_as_csv_are_the_times(tmp_path):
    path = tmp_path / "times.csv"
    _, shown, _ = opsim("motion", "sample", BENCH, "reach", "-n", 5, "-o", path, "--json")
    rows = list(csv.DictReader(path.open()))
    assert [float(row["duration_s"]) for row in rows] == [
        row["duration_s"] for row in json.loads(shown)["performances"]
    ]


def test_the_seed_decides_the_samples():
    first, again, other = (
        opsim("motion", "sample", "bench_work", "reach", "--seed", s, "--json")[1] for s in (1, 1, 2)
    )
    assert first == again != other


@pytest.mark.parametrize(
    "words, said",
    [
        (["missing.npz", "reach"], "shipped ones: bench_work"),
        ([__file__, "reach"], "test_motion.py"),
        ([BENCH, "raech"], "did you mean 'reach'?"),
        ([BENCH], "name one"),
        ([BENCH, "reach", "-n", "0"], "-n"),
        (
            [BENCH, "reach", "-n", "2", "--new-people", "3"],
            "--new-people: found 3, expected at most the 2 performances",
        ),
        ([BENCH, "reach", "--person", "w1", "--new-people", "3"], "--person: found together with --new-people"),
        (["bench_work/raech"], "did you mean 'reach'?"),
        ([BENCH, "reach", "-o", "x.txt"], ".csv"),
    ],
)
def test_sample_refuses_what_it_cannot_use(tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    code, _, complaint = opsim("motion", "sample", *words)
    assert code == 2 and said in complaint and list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending, begins", [("png", b"\x89PNG"), ("svg", b"<svg ")])
def test_show_draws_a_picture_and_names_its_source(tmp_path, ending, begins):
    path = tmp_path / f"reach.{ending}"
    code, shown, _ = opsim("motion", "show", BENCH, "reach", "-n", 1, "-o", path)
    assert code == 0 and path.read_bytes().startswith(begins) and "source: synthetic" in shown


def test_show_as_json_is_json(tmp_path):
    _, shown, _ = opsim("motion", "show", BENCH, "reach", "-n", 1, "-o", tmp_path / "x.png", "--json")
    assert json.loads(shown)["task"] == "reach"


def test_show_refuses_another_ending(tmp_path):
    code, _, complaint = opsim("motion", "show", BENCH, "reach", "-o", tmp_path / "x.gif")
    assert code == 2 and ".png or .svg" in complaint


MOTION_ASKED_BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def complaint_on(*words):
    code, said, complaint = opsim("motion", "show", MOTION_ASKED_BENCH, "reach", *words)
    assert code == 2 and said == ""
    return complaint.strip()


@pytest.mark.parametrize(
    "words, said",
    [
        (["--video", "--beside", "x.npz"], "--video: found together with --beside, expected one of them"),
        (["--video", "--where", "all"], "--where: found without --beside, expected --beside RECORDING.npz"),
        (["--people", "new"], "--people: found without --video or --beside, expected one of them"),
        (["--person", "w1"], "--person: found without --video, expected --video"),
        (
            ["--video", "--people", "new", "--person", "w1"],
            "--person: found together with --people, expected one of them",
        ),
        (["--video", "-n", "0"], "-n: found 0, expected 1 to 20"),
        (["-n", "21"], "-n: found 21, expected 1 to 20"),
        (["--video", "-o", "x.avi"], "x.avi: found the ending '.avi', expected .html or .gif or .mp4 with --video"),
        (["--video", "-o", "x"], "x: found the ending '', expected .html or .gif or .mp4 with --video"),
        (["-o", "x.pdf"], "x.pdf: found the ending '.pdf', expected .png or .svg"),
        (["-o", "x.gif"], "x.gif: found the ending '.gif', expected .png or .svg, or --video: it is for what moves"),
        (["--video", "--person", "w1x"], "--person: reach: no worker 'w1x'; did you mean 'w1'?"),
    ],
)
def test_a_mistake_is_said_with_what_was_found_and_expected(folder, words, said):
    assert complaint_on(*words).splitlines() == [said]
    assert list(folder.iterdir()) == []


def test_all_mistakes_are_said_at_once(folder):
    words = ("--video", "-n", 99, "-o", "x.avi", "--where", "all")
    code, _, complaint = opsim("motion", "show", MOTION_ASKED_BENCH, "raech", *words)
    said = complaint.strip().splitlines()
    assert code == 2 and [line.partition(":")[0] for line in said[:3]] == ["--where", "-n", "x.avi"]
    assert len(said) == 4 and "did you mean 'reach'?" in said[3]


def test_a_folder_that_is_none_is_said_together_with_the_rest(folder):
    (folder / "file").write_text("")
    said = complaint_on("--video", "-n", 0, "-o", "file/x.gif").splitlines()
    assert said[0].startswith("-n: found 0") and "file/x.gif: cannot be written" in said[1]


def test_without_an_encoder_mp4_is_refused_before_anything_is_drawn(folder, monkeypatch):
    monkeypatch.setenv("PATH", str(folder))
    said = complaint_on("--video", "-o", "x.mp4")
    assert "found no program ffmpeg" in said and ".html or .gif" in said and list(folder.iterdir()) == []


def test_a_library_that_is_not_there_is_said_with_those_that_are(folder):
    code, _, complaint = opsim("motion", "show", "bench_wrok", "reach", "--video")
    assert code == 2 and "did you mean 'bench_work'?" in complaint


@pytest.mark.parametrize("words", [("-o", "x.png"), ("--video", "-o", "x.GIF")])
def test_without_matplotlib_it_is_said_before_anything_is_drawn(folder, monkeypatch, words):
    monkeypatch.setattr("opsim.report.page.find_spec", lambda name: None)
    ending = words[-1][2:].upper()
    assert complaint_on(*words).startswith(f"{ending} files need matplotlib, which is not installed")
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("words", [("-n", 1, "-o", "x.svg"), ("--video", "-n", 1)])
def test_drawings_and_pages_need_no_matplotlib(folder, monkeypatch, words):
    monkeypatch.setattr("opsim.report.page.find_spec", lambda name: None)
    assert opsim("motion", "show", MOTION_ASKED_BENCH, "reach", *words)[0] == 0


def test_performances_are_files_that_hold_their_joints(tmp_path):
    code, shown, _ = opsim(
        "motion", "sample", BENCH, "reach", "-n", 3, "--seed", 3, "--fps", 25, "-o", tmp_path / "a.bvh"
    )
    assert code == 0 and f"{tmp_path / 'a_k0.bvh'} to a_k2.bvh" in shown
    drawn = MotionLibrary.load(BENCH)["reach"].sample(3, np.random.default_rng(3))
    for k in range(3):
        take = read_bvh(tmp_path / f"a_k{k}.bvh")
        assert take.rate_hz == 25 and take.duration_s == pytest.approx(drawn.duration_s[k], abs=0.5 / 25)
        places = drawn[k].positions_m(times_s=np.arange(take.n_frames) / 25)[0]
        order = [take.names.index(name) for name in drawn.skeleton.names]
        assert np.abs(take.positions_m[:, order] - places).max() < 1e-7
        bones = np.linalg.norm(take.positions_m[:, 1:] - take.positions_m[:, list(take.parents[1:])], axis=2)
        assert np.ptp(bones, axis=0).max() < 1e-6


def test_one_performance_is_one_file_of_that_name(tmp_path):
    assert opsim("motion", "sample", BENCH, "reach", "-n", 1, "-o", tmp_path / "one.BVH")[0] == 0
    assert [path.name for path in tmp_path.iterdir()] == ["one.BVH"]


def test_ten_files_stand_in_order(tmp_path):
    assert opsim("motion", "sample", BENCH, "reach", "-n", 11, "--fps", 5, "-o", tmp_path / "a.bvh")[0] == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == [f"a_k{k:02d}.bvh" for k in range(11)]


def test_a_drawn_movement_comes_back_where_it_was_facing_as_it_did(tmp_path):
    words = ("motion", "sample", BENCH, "reach", "-n", 1, "--seed", 5, "--fps", 25, "-o")
    assert opsim(*words, tmp_path / "s.npz")[0] == 0 and opsim(*words, tmp_path / "x.bvh")[0] == 0
    code, _, err = opsim("motion", "import", tmp_path / "x.bvh", "-o", tmp_path / "back.npz")
    assert code == 0, err
    (one,), (other,) = (read_recording(tmp_path / name).takes for name in ("s.npz", "back.npz"))
    order = [other.names.index(name) for name in one.names]
    assert np.abs(one.positions_m - other.positions_m[:, order]).max() < 1e-6


def test_files_of_an_earlier_draw_do_not_stay_beside_the_new_ones(tmp_path):
    out = tmp_path / "x.bvh"
    words = ("motion", "sample", BENCH, "reach", "--fps", 5, "-o", out, "-n")
    assert opsim(*words, 3)[0] == 0
    (tmp_path / "x_k7.bvh").write_text("HIERARCHY\nROOT Hips\n{\n")
    (tmp_path / "x_kept.bvh").write_text("mine")
    code, shown, _ = opsim(*words, 2)
    assert code == 0 and "removed, of an earlier draw: x_k2.bvh" in shown
    assert "left beside them, not of this draw: x_k7.bvh" in shown
    assert sorted(p.name for p in tmp_path.iterdir()) == ["x_k0.bvh", "x_k1.bvh", "x_k7.bvh", "x_kept.bvh"]
    code, shown, _ = opsim(*words, 1)
    assert code == 0 and "x_k0.bvh, x_k1.bvh" in shown
    assert sorted(p.name for p in tmp_path.iterdir()) == ["x.bvh", "x_k7.bvh", "x_kept.bvh"]


MOTION_OVERWRITE_BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def made_reach(tmp_path_factory):
    path = tmp_path_factory.mktemp("made") / "reach.npz"
    assert opsim("motion", "sample", MOTION_OVERWRITE_BENCH, "reach", "-n", 6, "--fps", 20, "-o", path)[0] == 0
    return path


@pytest.fixture
def motion_overwrite_folder(made_reach, tmp_path, monkeypatch):
    """A folder to stand in, with two recordings, a library under two names and a link to each kind."""
    for name in ("reach.npz", "other.npz"):
        shutil.copy(made_reach, tmp_path / name)
    for name in ("lib.npz", "lib.html"):
        shutil.copy(MOTION_OVERWRITE_BENCH, tmp_path / name)
    (tmp_path / "link.npz").symlink_to("reach.npz")
    (tmp_path / "same.npz").symlink_to("lib.npz")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(emulator.MotionEmulator, "fit", lambda *_, **__: pytest.fail("the fit began"))
    return tmp_path


@pytest.mark.parametrize(
    "words, said",
    [
        ("fit reach.npz -o reach.npz", "reach.npz: found the recording that is read, expected another file to write"),
        ("fit reach.npz -o ../{}/reach.npz", "reach.npz: found the recording that is read"),
        ("fit reach.npz -o link.npz", "link.npz: found the recording that is read"),
        ("fit reach.npz -o other.npz", "other.npz: found a recording, expected a new file or a library to replace"),
        ("sample lib.npz reach -o lib.npz", "lib.npz: found the library that is read"),
        ("sample lib.npz reach -o same.npz", "same.npz: found the library that is read"),
        ("sample bench_work reach -o lib.npz", "lib.npz: found a library, expected a new file or a recording"),
        ("show lib.html reach --video -o lib.html", "lib.html: found the library that is read"),
        ("show lib.html reach --beside reach.npz -o lib.html", "lib.html: found the library that is read"),
        ("judge reach.npz -o reach.npz", "reach.npz: found a file"),
        ("judge reach.npz --paper -o reach.npz", "reach.npz: found a file"),
        ("people reach.npz -o reach.npz", "reach.npz: found a file"),
    ],
)
def test_what_is_read_is_never_written_over(motion_overwrite_folder, words, said):
    before = {path.name: path.read_bytes() for path in motion_overwrite_folder.iterdir()}
    code, _, complaint = opsim("motion", *words.format(motion_overwrite_folder.name).split())
    assert code == 2 and said in complaint
    assert {path.name: path.read_bytes() for path in motion_overwrite_folder.iterdir()} == before


def test_a_library_replaces_a_library_and_a_recording_a_recording(motion_overwrite_folder, monkeypatch):
    monkeypatch.undo()
    monkeypatch.chdir(motion_overwrite_folder)
    assert opsim("motion", "fit", "reach.npz", "--n-components", 2, "-o", "lib.npz")[0] == 0
    assert (motion_overwrite_folder / "lib.npz").read_bytes() != MOTION_OVERWRITE_BENCH.read_bytes()
    assert opsim("motion", "sample", "lib.npz", "reach", "-n", 2, "-o", "other.npz")[0] == 0
    assert (motion_overwrite_folder / "other.npz").read_bytes() != (motion_overwrite_folder / "reach.npz").read_bytes()
