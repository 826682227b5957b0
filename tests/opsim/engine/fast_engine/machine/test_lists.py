"""Lists of raw memory against Python's own."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from made_machine import as_box, as_floor, empty_floor, entered

from opsim.engine.fast_engine.machine import clear, drop, drop_at, index_of, insert, pop_first, pop_last, push

PUSH, INSERT, POP_FIRST, POP_LAST, DROP_AT, DROP, CLEAR, INDEX = range(8)


@entered
def done_to(floor_at, box_at, what, which, answers):
    floor, box = as_floor(floor_at), as_box(box_at)
    numbers = box.numbers
    for i in range(what.size):
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
    done_to(floor.address, box.address, what, which, answers)
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
        done_to(floor.address, box.address, np.zeros_like(which), which, np.zeros_like(which))
    assert all(len(box.numbers) == 100_000 and box.numbers[99_999] == 99_999 for box in boxes)
    assert all(list(box.numbers)[:1000] == list(range(1000)) for box in boxes)
