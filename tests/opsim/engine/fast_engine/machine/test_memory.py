"""Memory that is given back is taken again for what is no larger; where there is none, that is an error.

Memory seen from Python: what is written is read, what is frozen comes back.

Lists of raw memory against Python's own.
"""

import ctypes
from itertools import pairwise
from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made.machine import Box, Floor, Given, empty_floor, entered
from twins import twins

from opsim.engine.fast_engine.machine import (
    clear,
    drop,
    drop_at,
    fresh,
    give_back,
    index_of,
    insert,
    pop_first,
    pop_last,
    push,
)
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
def taken(floor: Floor, given: Given) -> None:
    for i in range(given.n):
        given.b[i] = take_bytes(floor.memory, given.a[i])


@entered
def given_back(floor: Floor, given: Given) -> None:
    for i in range(given.n):
        give_bytes_back(floor.memory, given.b[i], given.a[i])


def addresses_of(floor, sizes):
    found = np.zeros(len(sizes), dtype=np.int64)
    taken(floor.address, a=np.array(sizes, dtype=np.int64), b=found, n=len(sizes))
    return found


@given(st.integers(1, 1 << 24))
def test_a_class_has_room_for_its_sizes_and_not_for_twice_as_much(words):
    n_bytes = 16 * words
    which = class_of(n_bytes)
    room = room_of(which)
    assert n_bytes <= room < 2 * n_bytes and which < CLASSES
    assert class_of(room) == which


@given(st.lists(st.integers(1, 600), min_size=1, max_size=30), st.lists(st.integers(1, 600), min_size=1, max_size=30))
def test_what_is_taken_lies_apart_also_where_it_was_given_back_before(first, second):
    arena, floor = empty_floor()
    arena.freeze()
    sizes = [16 * n for n in first]
    kept = addresses_of(floor, sizes)
    half = np.array(sizes[::2], dtype=np.int64)
    given_back(floor.address, a=half, b=kept[::2].copy(), n=half.size)
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


_new_box, _forget_box = fresh(Box), give_back(Box)


@entered
def _made_boxes(floor: Floor, given: Given) -> int:
    """Makes boxes, each after the other; gives all but every m-th back. How many are in the row at the end."""
    first = given.box
    for i in range(given.n):
        box = _new_box(floor)
        if box.n != 0 or box.weight != 0 or len(box.numbers) != 0:
            return -1
        box.n, box.weight = i + 1, 0.5
        if i % given.m == 0:
            box.next = first.next
            first.next = box
        else:
            _forget_box(floor, box)
    count = 0
    box = first.next
    while box:
        count += 1
        box = box.next
    return count


def made_boxes(floor, box, n, keep):
    return _made_boxes(floor, box=box, n=n, m=keep)


def test_fields_hold_what_is_written():
    arena, _ = empty_floor()
    box, other = arena.new("Box"), arena.new("Box")
    box.n, box.weight, box.next = -5, inf, other
    box.weights.fill([0.25, -1.0])
    box.others.fill([other, box])
    assert (box.n, box.weight, box.next) == (-5, inf, other)
    assert list(box.weights) == [0.25, -1.0]
    assert list(box.others) == [other, box]
    box.next = None
    assert not box.next
    with pytest.raises(AttributeError, match="Box has no 'm'"):
        box.m = 1


def test_what_was_given_back_is_used_again_and_comes_empty():
    arena, floor = empty_floor()
    box = arena.new("Box")
    arena.freeze()
    assert made_boxes(floor.address, box, 100_000, 1000) == 100
    assert arena.n_bytes < 1_000_000, "100 boxes are kept: the others' memory serves again and again"
    arena.restore()
    assert made_boxes(floor.address, box, 20_000, 1) == 20_000


def test_a_frozen_floor_is_had_again_at_the_same_addresses():
    arena, floor = empty_floor()
    box = arena.new("Box")
    box.numbers.fill(range(10))
    arena.freeze()
    for _ in range(3):
        assert made_boxes(floor.address, box, 50_000, 7) == 7143
        box.numbers.append(4)
        n_bytes = arena.n_bytes
        arena.restore()
        assert not box.next
        assert list(box.numbers) == list(range(10))
        assert arena.n_bytes == n_bytes, "memory is kept for the next run"


PUSH, INSERT, POP_FIRST, POP_LAST, DROP_AT, DROP, CLEAR, INDEX = range(8)


@entered
def _done_to(floor: Floor, given: Given) -> None:
    numbers, what, which, answers = given.box.numbers, given.a, given.b, given.c
    for i in range(given.n):
        n = len(numbers)
        at = which[i] % (n + 1)
        if what[i] == PUSH:
            push(floor, numbers, which[i])
        elif what[i] == INSERT:
            insert(floor, numbers, at, which[i])
        elif what[i] == CLEAR:
            clear(numbers)
        elif what[i] == INDEX:
            answers[i] = index_of(numbers, which[i])
        elif what[i] == DROP:
            answers[i] = drop(numbers, which[i])
        elif n and what[i] == POP_FIRST:
            answers[i] = pop_first(numbers)
        elif n and what[i] == POP_LAST:
            answers[i] = pop_last(numbers)
        elif n and what[i] == DROP_AT:
            drop_at(numbers, which[i] % n)


def done_to(floor, box, what, which, answers):
    _done_to(floor, box=box, a=what, b=which, c=answers, n=what.size)


def done_in_python(actions):
    numbers, answers = [], []
    for what, which in actions:
        answer = -9
        if what == PUSH:
            numbers.append(which)
        elif what == INSERT:
            numbers.insert(which % (len(numbers) + 1), which)
        elif what == CLEAR:
            numbers.clear()
        elif what == INDEX:
            answer = numbers.index(which) if which in numbers else -1
        elif what == DROP:
            answer = int(which in numbers)
            if answer:
                numbers.remove(which)
        elif numbers and what in (POP_FIRST, POP_LAST):
            answer = numbers.pop(0 if what == POP_FIRST else -1)
        elif numbers and what == DROP_AT:
            del numbers[which % len(numbers)]
        answers.append(answer)
    return numbers, answers


@settings(max_examples=200, deadline=None)
@given(st.lists(st.tuples(st.sampled_from([PUSH] * 3 + list(range(8))), st.integers(0, 12)), max_size=80))
def test_a_list_is_what_pythons_would_be(actions):
    arena, floor = empty_floor()
    box, other = arena.new("Box"), arena.new("Box")
    other.numbers.fill([7, 8, 9])
    arena.freeze()
    what, which = (np.array([pair[i] for pair in actions], dtype=np.int64) for i in (0, 1))
    answers = np.full(len(actions), -9)
    done_to(floor.address, box, what, which, answers)
    numbers, wanted = done_in_python(actions)
    assert list(box.numbers) == numbers
    assert answers.tolist() == wanted
    assert list(other.numbers) == [7, 8, 9], "memory of something else was written"


def test_lists_of_many_items_grow_over_several_chunks_of_memory():
    arena, floor = empty_floor()
    boxes = [arena.new("Box") for _ in range(3)]
    arena.freeze()
    which = np.arange(100_000, dtype=np.int64)
    for box in boxes:
        done_to(floor.address, box, np.zeros_like(which), which, np.zeros_like(which))
    assert all(len(box.numbers) == 100_000 and box.numbers[99_999] == 99_999 for box in boxes)
    assert all(list(box.numbers)[:1000] == list(range(1000)) for box in boxes)
