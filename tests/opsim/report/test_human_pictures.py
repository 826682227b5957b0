from dataclasses import replace
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest

from opsim.engine.floor.run import run_plan
from opsim.ergonomics.scores.scoring import NOTHING_OPEN
from opsim.ergonomics.shift.movement import scored_movements
from opsim.history import practice, tiredness
from opsim.report.motion.scoring import LEVELS, MOST_ROWS, SLIM_IN, WIDE_IN, course_svg, level_colour
from opsim.report.motion.segmentation import draw_agreement
from opsim.report.sections.learning_fatigue import curves_of
from tests.human_plans import LINE, planned
from tests.opsim.ergonomics.shift.test_movement import movement

BOTH = "human: {fatigue: {model: lffrm}, learning: {model: wright, rate: 0.85}}"


@pytest.fixture(scope="module")
def shown():
    plan = planned(LINE, BOTH)
    log = run_plan(plan)
    return log, plan, curves_of(log, plan, "Mon 06:00")


def test_a_curve_of_fatigue_ends_where_the_replay_does(shown):
    log, plan, (fatigue, _) = shown
    found = tiredness(log, plan)
    for rank, line in enumerate(fatigue.figure["data"]):
        assert line["y"][-1] == pytest.approx(100 * found.end[log["worker"][found.row] == rank][-1], abs=1e-3)
        assert line["y"][0] == 0 and line["name"] == plan.workers[rank].name
    assert fatigue.note.startswith("Most tired is")


def test_a_curve_of_learning_falls_from_the_first_repetition(shown):
    log, plan, (_, learning) = shown
    share = practice(log, plan).multiplier / plan.human.learning.multiplier(1.0)
    assert min(min(line["y"]) for line in learning.figure["data"]) == pytest.approx(100 * share.min(), abs=1e-3)
    assert all(line["y"][0] == 100 and line["y"][-1] < 100 for line in learning.figure["data"])
    assert "ana, cut" in learning.said


def test_recovery_through_a_long_pause_is_a_curve_and_no_straight_line():
    """Half of it is gone after recovers_half_in, long before the middle of the pause."""
    text = LINE + "shifts: {early: {from: 06:00, to: 10:00, breaks: {long: {at: 07:00, lasts: 2 h}}}}\n"
    for name in ("ana", "ben", "cy"):
        text = text.replace(f"{name}: {{", f"{name}: {{shift: early, ")
    plan = planned(text, "human: {fatigue: {model: lffrm, recovers_half_in: 20 min}}")
    ana = curves_of(run_plan(plan), plan, "Mon 06:00")[0].figure["data"][0]
    at_s, value = np.array(ana["x"]), np.array(ana["y"])
    last = np.flatnonzero(at_s <= 3700)[-1]
    first = np.flatnonzero(at_s > 10000)[0]
    within = slice(last, first)
    assert first - last >= 8 and (np.diff(value[within]) <= 0).all()
    half = value[last] / 2
    assert np.interp(at_s[last] + 1200, at_s, value) == pytest.approx(half, rel=0.1)


def test_without_effects_there_is_no_curve():
    plan = planned(LINE)
    assert curves_of(run_plan(plan), plan, "Mon 06:00") == []


def test_scores_have_the_colour_of_their_action_level():
    """RULA 1-2, 3-4, 5-6, 7; REBA 1, 2-3, 4-7, 8-10, 11-15; OWAS 1, 2, 3, 4."""
    none, later, soon, _, now = LEVELS
    assert [level_colour("rula", score) for score in (1, 2, 3, 4, 5, 6, 7)] == [none] * 2 + [later] * 2 + [soon] * 2 + [
        now
    ]
    assert [level_colour("reba", score) for score in (1, 3, 4, 8, 11)] == list(LEVELS)
    assert [level_colour("owas", score) for score in (1, 2, 3, 4)] == [none, later, soon, now]


def test_a_row_shows_both_ends_of_an_interval():
    """Half of it in the colour of RULA 2, half in that of 7."""
    (one,) = scored_movements([movement(0.0, 0.0)], NOTHING_OPEN)
    wide = replace(one, scores=replace(one.scores, rula=np.array([[2, 7]] * 2, np.int8)))
    picture = course_svg([wide, wide], {}).decode()
    none, now = f"fill: {LEVELS[0]}", f"fill: {LEVELS[4]}"
    alone = replace(one, scores=replace(one.scores, rula=np.array([[2, 2]] * 2, np.int8)))
    assert picture.count(now) == course_svg([alone, alone], {}).decode().count(now) + 2 and none in picture


def test_a_slim_picture_is_as_high_and_less_wide():
    made = scored_movements([movement(0.0, 70.0)], NOTHING_OPEN)
    broad, slim = (ElementTree.fromstring(course_svg(made, {}, wide)).get("viewBox") for wide in (WIDE_IN, SLIM_IN))
    assert float(slim.split()[2]) < 0.5 * float(broad.split()[2]) and slim.split()[3] == broad.split()[3]


@pytest.mark.parametrize("n", [1, pytest.param(2, marks=pytest.mark.slow), MOST_ROWS + 1])
def test_a_picture_of_one_movement_and_of_many(n):
    made = [movement(0.0, 70.0, float("nan"), name=f"take {k}") for k in range(n)]
    picture = course_svg(scored_movements(made, NOTHING_OPEN), {(0, 1): "A"})
    root = ElementTree.fromstring(picture)
    assert root.tag.endswith("svg")
    assert n > 2 or picture == course_svg(scored_movements(made, NOTHING_OPEN), {(0, 1): "A"})


def test_a_picture_without_a_letter_is_of_the_first_movement():
    assert course_svg(scored_movements([movement(float("nan"))], NOTHING_OPEN), {}).startswith(b"<?xml")


def validation():
    rng = np.random.default_rng(0)
    body, mean = (
        SimpleNamespace(person_icc=1 - 0.02 * size * rng.random(18), sem_deg=size * rng.exponential(2.0, (18, 14)))
        for size in (1, 2)
    )
    body.sem_deg[0, 0] = np.nan
    return SimpleNamespace(task="lift & <carry>", by_body=body, by_mean=mean)


def test_the_picture_says_both_means_and_the_paper_s(tmp_path):
    made = validation()
    text = draw_agreement(made, tmp_path / "icc.svg").read_text(encoding="utf-8")
    assert f"by body {made.by_body.person_icc.mean():.3f}" in text
    assert f"by body {np.nanmean(made.by_body.sem_deg):.2f}" in text
    assert "paper 0.91" in text and "paper 4.16" in text
    assert "lift &amp; &lt;carry&gt;" in text


def test_the_same_figures_give_the_same_bytes(tmp_path):
    one, two = (draw_agreement(validation(), tmp_path / name).read_bytes() for name in ("a.svg", "b.svg"))
    assert one == two


@pytest.mark.parametrize("value", [0.95, 0.0])
def test_people_who_are_all_alike_can_be_drawn(tmp_path, value):
    same = SimpleNamespace(person_icc=np.full(3, value), sem_deg=np.full((3, 2), value))
    drawn = draw_agreement(SimpleNamespace(task="t", by_body=same, by_mean=same), tmp_path / "alike.png")
    assert drawn.read_bytes().startswith(b"\x89PNG")
