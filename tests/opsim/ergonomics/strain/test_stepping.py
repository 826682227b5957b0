"""Walking within a task, told by feet."""

import numpy as np

from opsim.ergonomics.angles import AT, COLUMNS
from opsim.ergonomics.strain.energy import stepping


def walks(left_m, right_m=0.0, every_s=0.1):
    left_m = np.asarray(left_m, float)
    measures = np.zeros((left_m.size, len(COLUMNS)))
    measures[:, AT["left_ankle_up_m"]], measures[:, AT["right_ankle_up_m"]] = left_m, right_m
    seconds = np.broadcast_to(np.asarray(every_s, float), left_m.shape)
    return stepping(measures, np.cumsum(seconds) - seconds, seconds)


def swing(n, period_s=1.1):
    """Left foot up, right foot up, in turn: above 0 the left is higher, below 0 the right."""
    turn = 0.08 * np.sin(2 * np.pi * np.arange(n) * 0.1 / period_s)
    return np.maximum(turn, 0.0), np.maximum(-turn, 0.0)


def test_feet_that_leave_the_floor_in_turn_walk():
    assert walks(*swing(60)).all()


def test_who_stands_or_stands_on_one_foot_does_not_walk():
    assert not walks(np.zeros(50)).any()
    assert not walks(np.r_[np.zeros(10), np.full(30, 0.3), np.zeros(10)]).any()


def test_a_foot_long_after_the_other_is_no_step():
    left, right = np.zeros(60), np.zeros(60)
    left[5:10], right[40:45] = 0.1, 0.1
    assert not walks(left, right).any()
    right[:], right[14:20] = 0.0, 0.1
    found = np.flatnonzero(walks(left, right, every_s=0.11))
    assert (found[0], found[-1]) == (9, 19)  # middles within 0.6 s of that of frame 14: 5 frames of 0.11 s either side


def test_only_the_walked_part_walks_and_unknown_feet_stand():
    left, right = swing(40)
    still = np.zeros(40)
    found = walks(np.r_[still, left, still], np.r_[still, right, still])
    assert not found[:35].any() and found[46:76].all() and not found[90:].any()
    assert not walks(np.full(20, np.nan)).any() and walks(np.empty(0)).size == 0
