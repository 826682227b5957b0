"""Memory that is given back is taken again for what is no larger; where there is none, that is an error."""

import ctypes
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_machine import as_floor, empty_floor, entered
from twins import twins

from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.machine.lists import CLASSES, class_of, give_bytes_back, room_of, take_bytes
from opsim.log import FINISH, QUEUE

N_STEPS = 260
CHAIN = "\n".join(f"  s{i}: {{at: hall, tasks: [cut]}}" for i in range(1, N_STEPS + 1))
ONWARD = ", ".join(f"s{i}: {{s{i + 1}: 0.03, out: 0.97}}" for i in range(1, N_STEPS))
LONG_ROUTE = f"""
opsim: 1
name: a long route beside a growing queue
run: {{horizon: 20 min, seed: 4}}
layout: {{places: {{hall: [0 m, 0 m]}}}}
tasks: {{cut: {{dist: exponential, mean: 1 s, automatic: true}}, soak: {{fixed: 10 min, automatic: true}}}}
stations:
  bath: {{at: hall, tasks: [soak], buffer: 1000}}
{CHAIN}
products:
  long: {{routing: {{start: {{s1: 1}}, {ONWARD}, s{N_STEPS}: {{out: 1}}}}}}
  slow: {{route: [bath]}}
sources:
  one: {{kind: poisson, every: 3 s, products: [long]}}
  two: {{kind: poisson, every: 2 s, products: [slow]}}
"""


@entered
def taken(floor_at, sizes, addresses):
    for i in range(sizes.size):
        addresses[i] = take_bytes(as_floor(floor_at).memory, sizes[i])


@entered
def given_back(floor_at, sizes, addresses):
    for i in range(sizes.size):
        give_bytes_back(as_floor(floor_at).memory, addresses[i], sizes[i])


def addresses_of(floor, sizes):
    found = np.zeros(len(sizes), dtype=np.int64)
    taken(floor.address, np.array(sizes, dtype=np.int64), found)
    return found


@given(st.integers(1, 1 << 24))
def test_a_class_has_room_for_its_sizes_and_not_for_twice_as_much(words):
    n_bytes = 16 * words
    which = class_of.py_func(n_bytes)
    room = room_of.py_func(which)
    assert n_bytes <= room < 2 * n_bytes and which < CLASSES
    assert class_of.py_func(room) == which


@given(st.lists(st.integers(1, 600), min_size=1, max_size=30), st.lists(st.integers(1, 600), min_size=1, max_size=30))
def test_what_is_taken_lies_apart_also_where_it_was_given_back_before(first, second):
    arena, floor = empty_floor()
    arena.freeze()
    sizes = [16 * n for n in first]
    kept = addresses_of(floor, sizes)
    given_back(floor.address, np.array(sizes[::2], dtype=np.int64), kept[::2].copy())
    again = [16 * n for n in second]
    blocks = sorted([*zip(kept[1::2], sizes[1::2]), *zip(addresses_of(floor, again), again)])
    assert all(at + n_bytes <= after for (at, n_bytes), (after, _) in pairwise(blocks))


def test_jobs_of_a_long_route_are_not_overwritten_by_a_queue_that_grows():
    log = twins(LONG_ROUTE)
    assert len(log.of(FINISH)) > 300 and len(log.of(QUEUE)) > 500


def test_where_python_gives_no_more_memory_nothing_is_written_beyond():
    arena, floor = empty_floor()
    arena.freeze()
    nothing = MORE(lambda _, n_bytes: 0)
    arena.memory.more = ctypes.cast(nothing, ctypes.c_void_p).value
    left = arena.memory.end - arena.memory.at
    addresses_of(floor, [left // 16 * 16 // 4])
    with pytest.raises(MemoryError):
        addresses_of(floor, [1 << 20])
    assert arena.memory.at <= arena.memory.end
