"""Memory seen from Python: what is written is read, what is frozen comes back."""

from math import inf

import pytest
from made_machine import Box, as_box, as_floor, empty_floor, entered

from opsim.engine.fast_engine.machine import fresh, give_back

_new_box, _forget_box = fresh(Box), give_back(Box)


@entered
def made_boxes(floor_at, box_at, n, keep):
    """Makes boxes, each after the other; gives all but those of ``keep`` back. How many are in the row at the end."""
    floor, first = as_floor(floor_at), as_box(box_at)
    for i in range(n):
        box = _new_box(floor)
        if box.n != 0 or box.weight != 0 or len(box.numbers) != 0:
            return -1
        box.n, box.weight = i + 1, 0.5
        if i % keep == 0:
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
    assert made_boxes(floor.address, box.address, 100_000, 1000) == 100
    assert arena.n_bytes < 1_000_000, "100 boxes are kept: the others' memory serves again and again"
    arena.restore()
    assert made_boxes(floor.address, box.address, 20_000, 1) == 20_000


def test_a_frozen_floor_is_had_again_at_the_same_addresses():
    arena, floor = empty_floor()
    box = arena.new("Box")
    box.numbers.fill(range(10))
    arena.freeze()
    for _ in range(3):
        assert made_boxes(floor.address, box.address, 50_000, 7) == 7143
        box.numbers.append(4)
        n_bytes = arena.n_bytes
        arena.restore()
        assert not box.next
        assert list(box.numbers) == list(range(10))
        assert arena.n_bytes == n_bytes, "memory is kept for the next run"
