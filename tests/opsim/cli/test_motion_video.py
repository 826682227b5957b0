"""``opsim motion show --video``: the mean performance beside simulated ones."""

import json

import numpy as np
import pytest
from PIL import Image

from emulator.model.mean_performance import mean_performance
from opsim.cli.motion.video import video
from opsim.libraries import load_library
from opsim.report.sections.motions import CARD_RATE_HZ as RATE_HZ
from opsim.shipped import shipped_folder
from tests.opsim.cli.calls import opsim

BENCH = shipped_folder() / "libraries" / "bench_work.npz"


@pytest.fixture(scope="module")
def reach():
    return load_library(BENCH)["reach"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def shown(*words):
    """What ``--json`` says of a video of reaching."""
    code, said, complaint = opsim("motion", "show", BENCH, "reach", "--video", *words, "--json")
    assert code == 0, complaint
    return json.loads(said)


def made(model, n=3, people="new", person=None, seed=0):
    return video(model, n=n, people=people, person=person, seed=seed)


def test_the_page_is_named_after_the_task_and_holds_the_mean_and_three(folder):
    said = shown()
    assert said["out"] == "reach.html" and (folder / "reach.html").read_text("utf-8").startswith("<!doctype html>")
    labels = [card["card"] for card in said["cards"]]
    assert labels == ["mean performance", "simulated 1", "simulated 2", "simulated 3"]


def test_a_gif_says_its_size_and_tells_how_far_it_is(folder):
    code, said, progress = opsim("motion", "show", BENCH, "reach", "--video", "-n", 1, "-o", "x.gif")
    assert code == 0 and "GIF: x.gif (0." in said and "draw reach: 0 of" in progress
    with Image.open("x.gif") as opened:
        assert opened.n_frames > 20


def test_the_folder_of_the_file_is_made(folder):
    assert (folder / shown("-n", 1, "-o", "new/deep/x.html")["out"]).is_file()


def test_the_seed_decides_the_bytes(folder):
    pages = []
    for seed in (1, 1, 2):
        shown("-n", 2, "--seed", seed, "-o", "x.html")
        pages.append((folder / "x.html").read_bytes())
    assert pages[0] == pages[1] != pages[2]


def test_the_simulated_ones_are_those_of_sample_with_the_same_seed(folder):
    _, said, _ = opsim("motion", "sample", BENCH, "reach", "-n", 3, "--seed", 5, "--json")
    drawn = [f"{row['duration_s']:.2f} s" for row in json.loads(said)["performances"]]
    assert [card["said"] for card in shown("--seed", 5)["cards"]][1:] == drawn


def test_the_mean_lasts_the_mean_duration(reach):
    mean = made(reach).mean
    assert mean.who == f"{reach.mean_duration_s():.2f} s"
    assert mean.duration_s == pytest.approx(reach.mean_duration_s(), abs=0.5 / RATE_HZ + 1e-9)


def test_the_mean_is_the_same_whatever_is_drawn_beside_it(reach):
    means = [made(reach, n=n, people=people, seed=n).mean.positions_m for n, people in ((1, "new"), (4, "recorded"))]
    assert np.array_equal(*means)


def test_people_of_the_fit_are_named_and_come_in_turn(reach):
    n = len(reach.workers)
    who = [card.who.partition(", ")[2] for card in made(reach, n=n + 1, people="recorded").drawn]
    assert sorted(who[:n]) == sorted(f"as {name}" for name in reach.workers) and who[n] == who[0]


def test_a_person_is_shown_beside_the_own_mean(reach):
    person = reach.workers[2]
    one = made(reach, person=person)
    assert one.mean.who == f"{mean_performance(reach, person).duration_s[0]:.2f} s" != made(reach).mean.who
    assert {card.who.partition(", ")[2] for card in one.drawn} == {f"as {person}"}
    assert one.lead.startswith(f"{person}'s mean performance beside 3 simulated ones")


def test_it_says_from_whom_it_was_emulated_and_that_nobody_was_recorded(folder):
    shown("-n", 1, "-o", "x.html")
    page = (folder / "x.html").read_text("utf-8")
    assert "beside 1 simulated one, emulated from 96 made repetitions of 12 made-up people: nobody was recorded" in page
    assert "new people, each another, as a simulation draws them; seed 0" in page


def test_pauses_are_said_where_there_are_any(reach):
    assert "paused" not in made(reach).mean.who and "pauses" not in dict(made(reach).notes)["Mean"]


def test_the_strip_shows_the_same_performances(folder, reach, monkeypatch):
    rows = []
    monkeypatch.setattr("opsim.report.sections.motions.draw_strips", lambda strips, *_, **__: rows.extend(strips))
    assert opsim("motion", "show", BENCH, "reach", "-n", 2, "--seed", 4, "-o", "x.svg")[0] == 0
    assert np.allclose(rows[0].positions_m, mean_performance(reach).positions_m(n_times=61)[0])
    assert [f"{row.duration_s:.2f} s" for row in rows] == [card.who for card in made(reach, n=2, seed=4).cards]
