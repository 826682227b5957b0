"""``opsim motion show --beside``: recorded and emulated performances on one page, unlabelled."""

import json
import shutil

import numpy as np
import pytest

from emulator import read_motions
from opsim.cli.motion.side_by_side import seen
from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim
from tests.recordings import recording

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def fitted(tmp_path_factory):
    """A folder with twelve recorded reaches of three people, and a library fitted to nine of them."""
    folder = tmp_path_factory.mktemp("beside")
    assert opsim("motion", "sample", BENCH, "reach", "-n", 12, "--fps", 25, "-o", folder / "made.npz")[0] == 0
    with np.load(folder / "made.npz") as file:
        people = np.repeat(["ana", "ben", "eva"], 4)
        np.savez(folder / "reach.npz", **{**file, "subject": people, "meta": json.dumps({"source": "a test"})})
    words = ("-o", folder / "lib.npz", "--where", "trial not in (k3, k7, k11)", "--n-times", 31)
    assert opsim("motion", "fit", folder / "reach.npz", *words)[0] == 0
    return folder


@pytest.fixture
def folder(fitted, tmp_path, monkeypatch):
    shutil.copytree(fitted, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def shown(*words):
    """What ``--json`` says of a page made in the folder."""
    code, said, complaint = opsim("motion", "show", "lib.npz", "--beside", "reach.npz", *words, "--json")
    assert code == 0, complaint
    return json.loads(said)


def test_the_page_holds_as_many_recorded_as_emulated_ones(folder):
    said = shown("-n", 2, "-o", "page.html")
    assert [card["card"] for card in said["cards"]] == ["A", "B", "C", "D"]
    assert sum(card["real"] for card in said["cards"]) == 2
    assert (folder / "page.html").read_text(encoding="utf-8").startswith("<!doctype html>")


def test_the_page_is_named_after_the_task(folder):
    assert shown("-n", 1)["out"] == "reach.html" and (folder / "reach.html").is_file()


def test_the_seed_decides_the_bytes(folder):
    pages = []
    for seed in (1, 1, 2):
        shown("-n", 3, "--seed", seed, "-o", "page.html")
        pages.append((folder / "page.html").read_bytes())
    assert pages[0] == pages[1] != pages[2]


def test_recorded_ones_are_of_different_people_while_there_are_any(folder):
    who = [card["who"].split(",")[0] for card in shown("-n", 3)["cards"] if card["real"]]
    assert sorted(who) == ["ana", "ben", "eva"]
    again = [card["who"].split(",")[0] for card in shown("-n", 6)["cards"] if card["real"]]
    assert sorted(again) == ["ana", "ana", "ben", "ben", "eva", "eva"]


def test_durations_of_recorded_ones_are_theirs_to_half_a_frame(folder):
    motions = {f"{m.worker}, repetition {m.trial}": m.duration_s for m in read_motions("reach.npz").motions}
    real = {card["who"]: card["duration_s"] for card in shown("-n", 6)["cards"] if card["real"]}
    assert all(abs(real[who] - motions[who]) <= 0.5 / 30 + 1e-3 for who in real)


def test_people_of_the_fit_are_named_on_the_reveal(folder):
    who = {card["who"] for card in shown("-n", 3, "--people", "recorded")["cards"] if not card["real"]}
    assert who == {"as ana", "as ben", "as eva"}
    assert {card["who"] for card in shown("-n", 2)["cards"] if not card["real"]} == {"a new person"}


@pytest.mark.parametrize(
    "where, said",
    [
        ("trial in (k3, k7, k11)", "none of the 3 recorded performances: all are unseen"),
        ("trial in (k1, k2, k3)", "2 of the 3 recorded performances"),
        ("trial in (k0, k1, k2)", "3 of the 3 recorded performances"),
    ],
)
def test_the_page_says_how_many_of_the_shown_the_fit_has_seen(folder, where, said):
    assert shown("-n", 3, "--where", where, "-o", "page.html")["notes"]["Seen in the fit"] == said
    assert said in (folder / "page.html").read_text(encoding="utf-8")


def test_what_the_fit_has_seen_is_not_guessed(folder):
    motions = read_motions("reach.npz", where=None).motions
    shutil.copy("reach.npz", "other.npz")
    report = load_library(folder / "lib.npz").only().report
    changed = {"where": "a predicate"}, {"where": "trial != k3"}, {"where": "cov_x==1"}, {"command": ""}
    assert seen(report, motions[3:4], "other.npz").startswith("not known")
    for change in changed:
        other = type("Report", (), {**report.as_dict(), **change})
        assert seen(other, motions[3:4], "reach.npz").startswith("not known")


def test_the_answers_are_not_printed_to_people(folder):
    code, said, _ = opsim("motion", "show", "lib.npz", "--beside", "reach.npz", "-n", 2)
    assert code == 0 and "page: reach.html" in said and "a new person" not in said and "real" not in said


@pytest.mark.parametrize(
    "words, said",
    [
        (["--beside", "reach.npz", "-o", "x.png"], "x.png: found the ending '.png', expected .html with --beside"),
        (["-o", "x.html"], "expected .png or .svg, or --video or --beside RECORDING.npz: it is for what moves"),
        (["--where", "all"], "--where: found without --beside"),
        (["--people", "new"], "--people: found without --video or --beside"),
        (["--beside", "reach.npz", "-n", "14"], "-n: found 14, expected at most 13 with --beside"),
        (["--beside", "reach.npz", "-n", "13"], "reach.npz: found 12 repetitions (all), expected 13 or more for -n 13"),
        (["--beside", "raech.npz"], "raech.npz: no such file"),
        (["--beside", "lib.npz"], "lib.npz: not a recording"),
        (["--beside", "reach.npz", "--where", "trail == k1"], "did you mean 'trial'?"),
        (["--beside", "reach.npz", "--where", "trial == k99"], "no repetition is left"),
        (["raech", "--beside", "reach.npz"], "did you mean 'reach'?"),
        (["--beside", "reach.npz", "--people", "old"], "'old' is not one of 'new', 'recorded'"),
    ],
)
def test_what_does_not_go_together_is_said(folder, words, said):
    code, _, complaint = opsim("motion", "show", "lib.npz", *words)
    assert code == 2 and said in complaint
    assert not [path.name for path in folder.iterdir() if path.suffix in (".html", ".png")]


def test_all_that_does_not_go_together_is_said_at_once(folder):
    _, _, complaint = opsim("motion", "show", "lib.npz", "-o", "x.html", "--where", "all", "--people", "new")
    assert len(complaint.strip().splitlines()) == 3


def test_another_skeleton_is_refused_with_what_it_lacks(folder):
    with np.load("reach.npz") as file:
        names = [name for name in file["names"] if not name.endswith("hand")]
        keep = [list(file["names"]).index(name) for name in names]
        parents = [names.index(file["names"][p]) if p >= 0 else -1 for p in file["parents"][keep]]
        changes = {"names": names, "parents": parents, "positions": file["positions"][:, keep]}
        np.savez("handless.npz", **{**file, **changes})
    code, _, complaint = opsim("motion", "show", "lib.npz", "--beside", "handless.npz")
    assert code == 2 and complaint.strip() == (
        "handless.npz: found a skeleton of 19 joints, without left_hand, right_hand; "
        "expected the 21 joints of the task 'reach'"
    )


def test_public_recordings_stand_beside_the_shipped_library(tmp_path):
    out = tmp_path / "page.html"
    file = recording("uiprmd_deep_squat")
    code, said, _ = opsim("motion", "show", "public_movements", "deep_squat", "--beside", file, "-o", out)
    assert code == 0 and out.stat().st_size < 1_000_000
    assert "Seen in the fit: 4 of the 4 recorded performances" in said
