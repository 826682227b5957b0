"""Floors that lock themselves by stores, tools, kept places, buffers after, belts, cards and batches."""

from dataclasses import replace

import pytest
from plans import plan

from opsim.engine.floor import run_plan
from opsim.kpi.deadlock import locked
from opsim.laws import audit
from opsim.log import BATCH, HELD, NO_PARTS, QUEUE, SETUP, WORK
from opsim.plan.sources import SCHEDULE, OrderPlan
from tests.opsim.kpi.locking import ALL, CARDS, STORE

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
