import numpy as np
import pytest

from opsim.engine.floor import run_plan
from opsim.history import practice, tiredness
from opsim.report.sections.learning_fatigue import curves_of
from tests.human_plans import LINE, planned

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
