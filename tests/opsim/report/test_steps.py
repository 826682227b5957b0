import numpy as np
import pytest
from plans import CELL, ran

from opsim.log import CREATE, JOB_KINDS, LEAVING_KINDS
from opsim.report.sections.wip import Steps, jobs_at, jobs_inside, share_full, steps_of, thinned


@pytest.fixture(scope="module")
def cell():
    return ran(CELL)


def test_jobs_that_come_and_go_at_one_instant_are_one_step():
    steps = steps_of(np.array([0.0, 5.0, 7.0]), np.array([5.0, 9.0]), 10.0)
    assert (steps.at_s.tolist(), steps.level.tolist()) == ([0, 7, 9], [1, 2, 1])
    assert steps.mean == pytest.approx((7 * 1 + 2 * 2 + 1 * 1) / 10)


def test_jobs_inside_are_those_created_less_those_who_left(cell):
    log, plan = cell
    inside = jobs_inside(log)
    for at_s, level in zip(inside.at_s, inside.level):
        come = np.count_nonzero(log["end_s"][log["kind"] == CREATE] <= at_s)
        gone = np.count_nonzero(log["end_s"][np.isin(log["kind"], LEAVING_KINDS)] <= at_s)
        assert level == come - gone
    assert inside.end_s == plan.horizon_s


def test_those_at_points_and_those_nowhere_are_all_jobs_inside(cell):
    log, plan = cell
    rows = (log["job"] >= 0) & (log["station"] < 0) & np.isin(log["kind"], JOB_KINDS)
    nowhere_s = (log["end_s"][rows] - log["start_s"][rows]).sum()
    there_s = sum((steps.level * steps.seconds).sum() for steps in jobs_at(log, len(plan.stations)))
    inside = jobs_inside(log)
    assert there_s + nowhere_s == pytest.approx((inside.level * inside.seconds).sum())


def test_a_window_cuts_the_first_and_the_last_level():
    steps = Steps(np.array([0.0, 4.0, 8.0]), np.array([1, 3, 0]), 10.0).within(2.0, 6.0)
    assert (steps.at_s.tolist(), steps.level.tolist(), steps.seconds.tolist()) == ([2, 4], [1, 3], [2, 2])


def test_a_thinned_line_keeps_every_peak_and_both_ends():
    rng = np.random.default_rng(2)
    level = np.abs(np.cumsum(rng.choice([-1, 1], 20_000)))
    steps = Steps(np.sort(np.r_[0.0, rng.uniform(0, 900, 19_999)]), level, 1000.0)
    at_s, shown = thinned(steps, 600)
    assert at_s.size <= 602 and (at_s[0], at_s[-1]) == (0.0, 1000.0) and shown[-1] == level[-1]
    assert (shown.min(), shown.max()) == (level.min(), level.max())
    assert np.all(np.diff(at_s) >= 0)
    few = Steps(np.array([0.0, 1.0]), np.array([0, 1]), 2.0)
    assert [part.tolist() for part in thinned(few, 600)] == [[0, 1, 2], [0, 1, 1]]


def test_the_share_without_room_is_of_the_window():
    steps = Steps(np.array([0.0, 4.0, 8.0]), np.array([1, 3, 0]), 10.0)
    assert share_full(steps, 3, (5.0, 10.0)) == pytest.approx(0.6)
    assert share_full(steps, np.inf, (5.0, 10.0)) == 0
