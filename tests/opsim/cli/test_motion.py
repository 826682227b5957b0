import csv
import json

import numpy as np
import pytest

from emulator import MotionLibrary, read_motions
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
    code, shown, progress = opsim("motion", "fit", emulated, "-o", out, "--where", "all")
    assert code == 0 and "12 of 1 workers" in shown and "ICC of log duration" in shown and "not estimable" in shown
    assert "fit reach: aligning" in progress
    library = MotionLibrary.load(out)
    assert library.command == "opsim motion fit reach.npz -o lib.npz --where 'all'" and library.tasks == ("reach",)


def test_fit_as_json_is_json(emulated, tmp_path):
    words = ("-o", tmp_path / "lib.npz", "--n-components", 3, "--json")
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


def test_a_recorded_task_is_fitted_with_its_six_people(tmp_path):
    code, shown, _ = opsim("motion", "fit", recording("uiprmd_deep_squat"), "-o", tmp_path / "lib.npz", "--json")
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
