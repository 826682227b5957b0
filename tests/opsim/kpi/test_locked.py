"""Floors that have locked themselves.

Floors that lock themselves by stores, tools, kept places, buffers after, belts, cards and batches.
"""

from dataclasses import replace

import pytest
from plans import CELL, line, plan

from opsim.engine.floor.run import run_plan
from opsim.kpi.deadlock import Locked, locked
from opsim.laws.audit import audit
from opsim.log import BATCH, BLOCKED, HELD, IDLE, JOB_BLOCKED, NO_PARTS, NO_WORKER, QUEUE, SETUP, WAIT, WORK
from opsim.subjects.release.plan import SCHEDULE, OrderPlan
from tests.opsim.kpi.locking import ALL as ALL_of_locked_by_all
from tests.opsim.kpi.locking import CARDS, STORE
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
    "batches": ("job 0 (a) in front of oven waits for its batch to fill, and there is no place at oven",),
}


@pytest.mark.parametrize("name", CIRCLES)
def test_the_circle_is_told_with_jobs_and_what_they_wait_for(name):
    p = plan(ALL_of_locked_by_all[name])
    assert locked(run_plan(p), p).circle == CIRCLES[name]


@pytest.mark.parametrize("name", ALL_of_locked_by_all)
def test_what_is_locked_obeys_the_laws_and_never_works_again(name):
    p = plan(ALL_of_locked_by_all[name])
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
    assert old in ALL_of_locked_by_all[name]
    p = plan(ALL_of_locked_by_all[name].replace(old, new))
    log = run_plan(p)
    assert locked(log, p) is None
    assert log["end_s"][log["kind"] == WORK].max() > p.horizon_s - 300


def test_loops_of_cards_that_end_where_others_begin_do_not_lock():
    p = plan(CARDS)
    assert locked(run_plan(p), p) is None


def test_what_is_left_of_a_lot_may_keep_the_card_of_the_next_one():
    p = plan("""
opsim: 1
name: lots
run: {horizon: 1000 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {cast: {at: here, tasks: [t]}, fit: {at: here, tasks: [t]}}
stores: {bin: {at: here}}
cards: {loop: {n: 1, from: cast, to: bin, products: [bolt]}}
products: {bolt: {lot: 3, route: [cast, bin]}, bike: {route: [fit], parts: {fit: {bolt: 2}}}}
sources:
  bikes: {kind: renewal, every: {fixed: 70 s}, products: [bike]}
  bolts: {kind: renewal, every: {fixed: 30 s}, products: [bolt]}
""")
    circle = locked(run_plan(p), p).circle
    assert len(circle) == 3
    assert "bolt on its way waits for a card of loop" in circle
    assert "1 of bolt in bin waits for somebody at fit to take it" in circle


OVEN = """
opsim: 1
name: oven
run: {horizon: 8 h, seed: 1}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 1 min, automatic: true}}
stations: {oven: {at: here, tasks: [t], batch: {size: 4}}}
products: {log: {route: [oven]}}
"""
TIMED = "sources: {o: {kind: poisson, every: 50 min}}"


def test_a_batch_that_the_next_arrival_may_fill_is_not_locked():
    p = plan(OVEN + TIMED)
    log = run_plan(p)
    waits = log.of(QUEUE)
    assert BATCH in waits["cause"][waits["end_s"] == p.horizon_s]
    assert locked(log, p) is None


def test_a_batch_that_cards_keep_from_filling_is_locked():
    p = plan(OVEN + TIMED + "\ncards: {loop: {n: 3}}")
    (circle,) = (locked(run_plan(p), p).circle,)
    assert any("waits for its batch to fill" in step for step in circle)
    assert any("waits for a card of loop" in step for step in circle)


def test_what_is_left_of_a_batch_when_the_orders_are_done_is_locked():
    orders = tuple(OrderPlan(60.0 * n, n, 1, 0) for n in range(6))
    p = plan(OVEN + TIMED)
    source = replace(p.sources[0], kind=SCHEDULE, every_s=0.0, orders=orders)
    done, more = (replace(p, sources=(replace(source, n_late=n),)) for n in (0, 1))
    log = run_plan(done)
    assert locked(log, done).circle == ("job 4 (log and 1 more) in front of oven waits for its batch to fill",)
    assert locked(log, more) is None


def test_a_part_that_a_timed_source_may_still_bring_locks_nothing():
    p = plan(STORE.replace("every: 200 s", "every: 20 h").replace("capacity: 3", "capacity: unlimited"))
    log = run_plan(p)
    assert NO_PARTS in log.of(HELD)["cause"]
    assert locked(log, p) is None


DEAD_END = """
opsim: 1
name: dead end
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 30 s, automatic: true}}
stations: {s: {at: here, tasks: [t], buffer: 1}}
stores: {w: {at: here}}
products: {a: {route: [s, w]}}
cards: {l: {n: 2, from: s, to: w}}
sources: {o: {kind: saturated}}
"""


@pytest.mark.parametrize("kind", ["saturated", "base_stock, store: w, level: 3", "poisson, every: 1 min"])
def test_a_source_whose_cards_lie_in_a_store_for_good_is_told(kind):
    p = plan(DEAD_END.replace("kind: saturated", f"kind: {kind}"))
    assert set(locked(run_plan(p), p).circle) == {
        "2 of a in w waits for somebody to take it, and nothing does",
        "source o waits for a card of l",
    }


@pytest.mark.parametrize(
    "change", [("saturated", "base_stock, store: w, level: 2"), ("to: w", "to: s"), ("n: 2", "n: 500")]
)
def test_a_store_from_which_nothing_takes_is_no_lock_by_itself(change):
    p = plan(DEAD_END.replace(*change))
    assert locked(run_plan(p), p) is None


BOTH_OF_TWO = """
opsim: 1
name: both of two
run: {start: Mon 06:00, horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
shifts: {dawn: {from: 06:00, to: 06:05}, hour: {from: 06:00, to: 07:00}}
tasks: {t: {fixed: 30 s, automatic: true}}
stations: {make: {at: here, tasks: [t]}, fit: {at: here, tasks: [t]}}
stores: {w: {at: here}}
products: {a: {route: [make, w]}, b: {route: [fit], parts: {fit: {a: 2}}}}
sources:
  o: {kind: base_stock, store: w, level: 1, shift: dawn}
  calls: {kind: renewal, every: {fixed: 10 min}, products: [b]}
"""


def test_a_source_that_is_closed_when_the_run_ends_may_bring_more_when_it_opens():
    p = plan(BOTH_OF_TWO)
    log = run_plan(p)
    assert NO_PARTS in log.of(HELD)["cause"] and locked(log, p) is None
