"""What measuring postures costs: an assembly line of eight hours, every performance drawn and decoded again."""

import tracemalloc
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from bench.cpu import best_s

from opsim.engine.floor.run import run_plan
from opsim.ergonomics import trunk_exposure
from opsim.ergonomics.shift.day import fold
from opsim.ergonomics.shift.ledger import Booking
from opsim.ergonomics.walking import walking_exposure
from opsim.kpi import figures
from opsim.kpi.catalogue import POSTURE
from opsim.kpi.window import inside_s
from opsim.log import WORK
from opsim.plan import compile_plan
from opsim.scenario import read_scenarios
from opsim.study.assumptions import _has_body

MOST_S_PER_1000, FASTER_THAN_WORK, MOST_MB, MOST_TIMES = 0.2, 10_000, 64, 12
DAY_AND_NIGHT_S = 24 * 3600.0


@pytest.fixture(scope="module")
def day():
    """Plan, log, its performances of workers, and how long those were at it in the window."""
    plan = compile_plan(read_scenarios("pump_assembly")["base"])
    log = run_plan(plan)
    rows = np.flatnonzero((log["kind"] == WORK) & (log["worker"] >= 0))
    worked_s = inside_s(log, rows, plan)
    return plan, log, np.count_nonzero(worked_s), worked_s.sum()


def test_exposure_is_measured_many_times_faster_than_the_work_is_done(day):
    plan, log, n, worked_s = day
    found = trunk_exposure(log, plan).together()
    assert all(_has_body(task) for task in plan.tasks if not task.automatic)
    assert found.measured_s[0] == pytest.approx(worked_s) and found.unmeasured_s[0] == 0
    spent_s = best_s(lambda: trunk_exposure(log, plan), rounds=3)[0]
    print(
        f"\n{n} performances, {spent_s / n * 1000:.3f} s per 1,000; {worked_s / spent_s:,.0f} times as fast as the work"
    )
    assert spent_s / n * 1000 < MOST_S_PER_1000 and worked_s / spent_s > FASTER_THAN_WORK


def test_exposure_holds_little_at_a_time(day):
    plan, log, *_ = day
    tracemalloc.start()
    trunk_exposure(log, plan)
    peak_mb = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    print(f"\npeak {peak_mb:.0f} MB (target {MOST_MB})")
    assert peak_mb < MOST_MB


def test_a_day_with_walking_postures_costs_a_few_times_one_without():
    """Figures of posture alone, where people walk two fifths of eight hours: a few walks stand for all of somebody."""
    plan = replace(compile_plan(read_scenarios("walking_cell")["base"]), horizon_s=8 * 3600.0)
    log, without = run_plan(plan), replace(plan, walking=None)
    on_s, off_s = (best_s(partial(figures, log, of, POSTURE), rounds=3)[0] for of in (plan, without))
    walked_s = walking_exposure(log, plan).exposure.measured_s.sum()
    print(f"\n{on_s / off_s:.1f} times; {walked_s / (on_s - off_s):,.0f} times as fast as the walking is done")
    assert on_s < MOST_TIMES * off_s


@pytest.fixture(scope="module")
def day_and_night():
    """The assembly line round the clock, and its log: 4 people; 20 take five times as long, each one as long."""
    plan = replace(compile_plan(read_scenarios("pump_assembly")["base"]), horizon_s=DAY_AND_NIGHT_S)
    return plan, run_plan(plan)


def booked(log, plan):
    booking = Booking(plan.start_s)
    fold(log, plan, [booking])
    return booking.close()


def test_all_scores_of_a_day_are_found_many_times_faster_than_the_work_is_done(day_and_night):
    """Measures, RULA, REBA and OWAS as intervals, repetition, static holds and the ledger, 12 postures a second."""
    plan, log = day_and_night
    worked_s = booked(log, plan).seconds.sum()
    rows = np.flatnonzero((log["kind"] == WORK) & (log["worker"] >= 0))
    assert worked_s == pytest.approx(inside_s(log, rows, plan).sum())
    spent_s = best_s(lambda: booked(log, plan), rounds=2)[0]
    print(f"\n{worked_s / 3600:.0f} h of work in {spent_s:.1f} s: {worked_s / spent_s:,.0f} times as fast")
    assert worked_s / spent_s > FASTER_THAN_WORK


def test_memory_does_not_grow_with_the_length_of_the_day(day, day_and_night):
    peaks_mb = []
    for plan, log in ((day[0], day[1]), day_and_night):
        tracemalloc.start()
        booked(log, plan)
        peaks_mb.append(tracemalloc.get_traced_memory()[1] / 2**20)
        tracemalloc.stop()
    print(f"\npeak {peaks_mb[0]:.0f} MB for 8 h, {peaks_mb[1]:.0f} MB for 24 h (target {MOST_MB})")
    assert max(peaks_mb) < MOST_MB and peaks_mb[1] < peaks_mb[0] + 16
