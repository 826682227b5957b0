"""Floors that have locked themselves."""

import pytest
from plans import CELL, line, plan

from opsim.engine.floor import run_plan
from opsim.kpi.deadlock import Locked, locked
from opsim.log import BLOCKED, HELD, IDLE, JOB_BLOCKED, NO_WORKER, QUEUE, WAIT, WORK
from tests.opsim.kpi.made_logs import made, row

RING = """
opsim: 1
name: ring
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations:
  a: {at: here, tasks: [t], buffer: 0}
  b: {at: here, tasks: [t], buffer: 1}
  c: {at: here, tasks: [t], buffer: 0, servers: 2}
  d: {at: here, tasks: [t], buffer: 0}
products: {p: {route: [a, b, [c, d], b, a]}}
release: {kind: saturated}
workers: {w: {skills: {a: 1.0}}, z: {skills: {a: 1.0, b: 1.0}}}
"""
A, B, C, D = range(4)
"""Stations; c and d are one operation, ``c|d``."""
WANTS = {"a": 0, "b": 1, "c|d": 2}


def blocked(station, wants, since=50, job=None):
    return row(BLOCKED, since, 100, station=station, job=station if job is None else job, operation=WANTS[wants])


def lock(*rows, text=RING):
    p = plan(text)
    assert p.operations == tuple(WANTS)
    return locked(made(rows, p), p)


FULL_B = row(QUEUE, 40, 100, station=B, job=9)
TWO_AT_C = [blocked(C, "b", 60), blocked(C, "b", 70, job=8)]
AT_D = blocked(D, "b", 20)
ALL = [blocked(B, "c|d", 55), FULL_B, *TWO_AT_C, AT_D]


def test_a_ring_is_named_in_the_order_of_waiting_and_since_it_closed():
    assert lock(*ALL) == Locked(("b", "c", "d"), 70)


def test_who_only_waits_for_the_ring_is_not_of_it():
    p = plan(
        RING.replace("[a, b,", "[e, a, b,").replace("products:", "  e: {at: here, tasks: [t], buffer: 0}\nproducts:")
    )
    assert p.operations == (*WANTS, "e")
    behind = [blocked(A, "b", 10), blocked(4, "a", 5)]
    assert locked(made([*ALL, *behind], p), p) == Locked(("b", "c", "d"), 70)


@pytest.mark.parametrize("gone", ["a place in a buffer", "a server", "an alternative", "a worked job"])
def test_one_way_out_opens_the_ring(gone):
    rows = {
        "a place in a buffer": [row_ for row_ in ALL if row_ is not FULL_B],
        "a server": [row_ for row_ in ALL if row_ is not TWO_AT_C[1]],
        "an alternative": [row_ for row_ in ALL if row_ is not AT_D],
        "a worked job": [*(r for r in ALL if r is not AT_D), row(WORK, 95, 100, station=D, job=D)],
    }[gone]
    assert lock(*rows) is None


def test_what_ended_before_the_horizon_holds_nothing():
    assert (
        lock(*(row_ for row_ in ALL if row_ is not AT_D), row(BLOCKED, 20, 99, station=D, job=D, operation=1)) is None
    )


def test_a_job_that_wants_back_into_its_own_station_does_not_lock():
    assert lock(blocked(A, "a")) is None


def test_of_two_rings_the_one_that_closed_first_is_given():
    routes = "{p: {route: [a, d, a], share: 0.5}, q: {route: [c, b, c], share: 0.5}}"
    p = plan(RING.replace("servers: 2", "servers: 1").replace("{p: {route: [a, b, [c, d], b, a]}}", routes))
    wants = ((A, "d", 30), (D, "a", 40), (B, "c", 10), (C, "b", 50))
    rows = [row(BLOCKED, t, 100, station=s, job=s, operation=p.operations.index(to)) for s, to, t in wants]
    assert locked(made([*rows, FULL_B], p), p) == Locked(("a", "d"), 40)


HANDS = [
    row(HELD, 30, 100, station=A, job=5, cause=NO_WORKER),
    blocked(D, "a", 80),
    row(WAIT, 80, 100, worker=0, station=D, job=D, cause=JOB_BLOCKED),
    row(WAIT, 80, 100, worker=1, station=D, job=D, cause=JOB_BLOCKED),
]


def test_workers_who_stand_by_jobs_that_wait_for_them_lock_too():
    assert lock(*HANDS) == Locked(("a", "d"), 80, ("w", "z"))


def test_one_free_worker_who_can_come_is_enough():
    assert lock(*HANDS[:3], row(WAIT, 80, 100, worker=1, places=(0, 0), cause=IDLE)) is None


def test_a_run_into_its_own_tail_locks_when_both_want_the_others_place():
    """Two stations without buffers: at 20 s each has done a job that the other must take."""
    text = line(2, 0, horizon="100 s", warm_up="0 s").replace("dist: exponential, mean: 1 s", "fixed: 10 s")
    p = plan(text.replace("route: [s1, s2]", "route: [s1, s2, s1]").replace("buffer: 1", "buffer: 0"))
    assert locked(run_plan(p), p) == Locked(("s1", "s2"), 20)


def test_a_line_locks_never():
    p = plan(line(5, 0, horizon="1200 s"))
    assert locked(run_plan(p), p) is None


@pytest.mark.parametrize("replication", range(4))
def test_what_is_locked_stays_so_and_its_workers_stand(replication):
    """The cell whose workers stand by blocked jobs: a longer run finds the same ring, or one that closed later."""
    short, long = plan(CELL), plan(CELL.replace("2 h", "6 h"))
    log = run_plan(long, replication)
    before, after = locked(run_plan(short, replication), short), locked(log, long)
    assert after is not None and (before == after or (before is None and after.since_s > 7200))
    waited_for = [rank for rank, worker in enumerate(long.workers) if worker.name in after.workers]
    assert waited_for
    for rank in waited_for:
        assert set(log["kind"][(log["worker"] == rank) & (log["end_s"] > after.since_s)]) == {WAIT}


def test_workers_who_leave_blocked_jobs_do_not_lock_the_cell():
    p = plan(CELL.replace("held", "free").replace("2 h", "6 h"))
    assert locked(run_plan(p), p) is None
