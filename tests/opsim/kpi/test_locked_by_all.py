"""Floors that lock themselves by stores, tools, kept places, buffers after, belts, cards and batches."""

from dataclasses import replace

import pytest
from plans import plan

from opsim.engine.simpy_engine import run_plan
from opsim.kpi.locked import locked
from opsim.laws import audit
from opsim.log import SETUP, WORK
from tests.opsim.kpi.locking import ALL, CARDS

CIRCLES = {
    "store": (
        "job 0 (bike) at join waits for a frame",
        "job 1 (frame) at weld waits for a place in rack",
        "3 of wheel in rack waits for somebody at join to take it",
    ),
    "tools": ("job 2 (a) at one waits for a gun", "job 3 (b) at two waits for a jig"),
    "before": ("job 7 (a) at one waits for a place at two", "job 9 (b) at two waits for a place at one"),
    "after": ("job 9 (b) at one waits for a place at two", "job 11 (b) at two waits for a place at one"),
    "belt": (
        "job 8 (a) at belt waits for a place at two",
        "job 6 (a) at two waits for a place at one",
        "job 12 (a) at one waits for a place on belt",
    ),
    "batches": ("job 0 (a) in front of oven waits for a place at oven",),
}


@pytest.mark.parametrize("name", CIRCLES)
def test_the_circle_is_told_with_jobs_and_what_they_wait_for(name):
    p = plan(ALL[name])
    assert locked(run_plan(p), p).circle == CIRCLES[name]


@pytest.mark.parametrize("name", ALL)
def test_what_is_locked_obeys_the_laws_and_never_works_again(name):
    p = plan(ALL[name])
    ring = locked(run_plan(p), p)
    longer = replace(p, horizon_s=3 * p.horizon_s)
    log = run_plan(longer)
    audit(log, longer)
    assert locked(log, longer) == ring
    where = [rank for rank, place in enumerate(p.stations) if place.name in ring.stations]
    later = log.of(WORK, SETUP)
    assert not any((later["end_s"] > ring.since_s) & (later["station"] == where[0]))


WAYS_OUT = {
    "store": ("capacity: 3", "capacity: unlimited"),
    "tools": ("gun: {n: 1}", "gun: {n: 2}"),
    "before": ("two: {at: here, tasks: [t], buffer: 0}", "two: {at: here, tasks: [t]}"),
    "after": ("buffer: 1, buffer_after: 1", "buffer: unlimited, buffer_after: 1"),
    "belt": ("one: {at: here, tasks: [t], buffer: 1}", "one: {at: here, tasks: [t], buffer: unlimited}"),
    "loops": ("cards: {there: {n: 2, from: one, to: two}, back: {n: 2, from: two, to: one}}", ""),
    "batches": ("batch: {size: 3, of: product}", "batch: {size: 3, of: product, most_wait: 1 min}"),
}


@pytest.mark.parametrize("name", WAYS_OUT)
def test_more_of_what_they_wait_for_lets_them_go(name):
    old, new = WAYS_OUT[name]
    assert old in ALL[name]
    p = plan(ALL[name].replace(old, new))
    log = run_plan(p)
    assert locked(log, p) is None
    assert log["end_s"][log["kind"] == WORK].max() > p.horizon_s - 300


def test_loops_of_cards_that_end_where_others_begin_do_not_lock():
    p = plan(CARDS)
    assert locked(run_plan(p), p) is None
