"""Rows are put in order as they come: as a stable sort of all of them has it."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from made.machine import Floor, Given, empty_floor, entered
from twins import twins

from opsim.engine.fast_engine.log_rows import AT_ONCE, MOST_SORTED, Columns, flush_all, flush_rows, new_row
from opsim.engine.fast_engine.machine import complete, line_of
from opsim.log import COLUMNS, OFF, ORDER

CLOSED = """
opsim: 1
name: closed before and after
run: {start: Mon 00:00, horizon: 24 h, seed: 5}
layout: {places: {hall: [0 m, 0 m]}}
shifts: {day: {from: 06:00, to: 14:00}}
tasks: {soak: {fixed: 3 h, automatic: true}}
stations:
  a: {at: hall, tasks: [soak], buffer: 1000, shift: day}
  b: {at: hall, tasks: [soak], buffer: 1000, shift: day}
products: {one: {share: 0.5, route: [a]}, two: {share: 0.5, route: [b]}}
release: {kind: poisson, every: 7 min}
"""
rows = st.tuples(*([st.integers(0, 3)] * len(ORDER)))


@entered
def _written(floor: Floor, given: Given) -> None:
    found = given.a
    for i in range(given.n):
        at = i * given.m
        floor.now = found[at]
        row = new_row(floor, found[at + 2], found[at + 1])
        row.worker, row.station, row.source = found[at + 3], found[at + 4], found[at + 5]
        row.job, row.k, row.performance_id = found[at + 6], found[at + 7], i
    floor.now = 1e9
    flush_all(floor)


def written(floor, found):
    """Writes rows that end when they say, in the order of ``ORDER``; ``performance_id`` is which one it is."""
    _written(floor, a=found, n=found.shape[0], m=found.shape[1])


def columns_of(found, times=1):
    arena, floor = empty_floor()
    complete([flush_rows, flush_all])
    floor.flush_line = line_of(flush_rows)
    columns = Columns(arena, floor)
    arena.freeze()
    for _ in range(times):
        arena.restore()
        columns.begin()
        written(floor.address, np.array(found, dtype=np.int64).reshape(-1, len(ORDER)))
        made = columns.end()
    return made


def sorted_whole(found):
    """``performance_id`` of the rows as a stable sort of them all has them."""
    return sorted(range(len(found)), key=lambda i: found[i])


@settings(max_examples=100, deadline=None)
@given(st.lists(rows, max_size=60), st.booleans())
def test_the_order_is_that_of_a_stable_sort(found, as_they_end):
    if as_they_end:
        found = sorted(found, key=lambda row: row[0])
    columns = columns_of(found)
    assert columns["performance_id"].tolist() == sorted_whole(found)
    assert all(columns[name].dtype == kind for name, kind in COLUMNS.items())
    assert np.isnan(columns["pace_shift"]).all()
    assert (columns["task"] == -1).all()


def test_more_rows_than_there_is_room_for():
    found = [(i // 3, 0, i % 2, 0, 0, 0, 0, 0) for i in range(100_000)]
    assert columns_of(found, times=3)["performance_id"].tolist() == sorted_whole(found)


def test_an_instant_of_more_rows_than_are_put_in_order_at_once():
    found = [(7, 0, i % 2, 0, 0, 0, i, 0) for i in range(5 * AT_ONCE)]
    assert columns_of(found)["performance_id"].tolist() == sorted_whole(found)


def test_an_instant_of_more_rows_than_are_put_in_order_at_all_is_sorted_at_the_end():
    n = MOST_SORTED + 10
    found = [(3, 0, 0, 0, 0, 0, 0, 0), *((7, 0, 0, 0, 0, 0, -i // 2, 0) for i in range(n)), (7, 0, 0, 0, 0, 0, 1, 0)]
    arena, floor = empty_floor()
    complete([flush_rows, flush_all])
    floor.flush_line = line_of(flush_rows)
    columns = Columns(arena, floor)
    arena.freeze()
    columns.begin()
    written(floor.address, np.array(found, dtype=np.int64))
    assert floor.unordered == 1, "moved one by one"
    assert columns.end()["performance_id"].tolist() == sorted_whole(found)


def test_rows_of_the_horizon_stay_in_order_where_closed_hours_are_written_between_them():
    """Those of the first hours are of the past: rows of the horizon come into columns with them, too soon."""
    log = twins(CLOSED)
    assert len(log) > AT_ONCE and len(log.of(OFF)) == 4 and (log.of(OFF)["end_s"] == log.horizon_s).sum() == 2


def test_the_columns_of_one_run_stay_when_another_one_has_begun():
    first = [(i, 0, 1, 2, 3, 4, i, 5) for i in range(1000)]
    arena, floor = empty_floor()
    complete([flush_rows, flush_all])
    floor.flush_line = line_of(flush_rows)
    columns = Columns(arena, floor)
    arena.freeze()
    kept = []
    for shift in range(4):
        arena.restore()
        columns.begin()
        written(floor.address, np.array(first, dtype=np.int64) + shift)
        kept.append(columns.end())
    assert [made["job"][0] for made in kept] == [0, 1, 2, 3]
    assert [made["source"][999] for made in kept] == [4, 5, 6, 7]
