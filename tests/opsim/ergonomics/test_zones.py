"""Zones of EN 1005-4 and movements a minute."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.zones import movements, per_minute, verdicts


def test_a_movement_begins_beyond_the_edge_and_ends_well_below_it():
    """Up, a little back (17 is within 5 of 20), up again: one; right back to 14, up: another."""
    angle = np.array([0.0, 25.0, 17.0, 25.0, 14.0, 18.0, 21.0, np.nan, 30.0])
    assert np.flatnonzero(movements(angle, 20.0)).tolist() == [1, 6]
    assert movements(np.array([30.0, 30.0]), 20.0).tolist() == [True, False]
    assert movements(np.empty(0), 20.0).size == 0


def test_movements_are_counted_by_the_minute_of_the_clock():
    start_s = np.array([0.0, 30.0, 59.9, 60.0, 130.0])
    assert per_minute(np.array([True, True, False, True, False]), start_s).tolist() == [2, 2, 2, 1, 0]


def naive_movements(angle, beyond, back):
    up, found = False, []
    for value in angle:
        found.append(not up and value > beyond)
        up = True if value > beyond else False if value < beyond - back else up
    return found


@given(st.lists(st.sampled_from([0.0, 14.9, 15.0, 18.0, 20.0, 20.1, 40.0, np.nan]), max_size=40))
def test_movements_are_the_naive_ones(angle):
    assert movements(np.array(angle), 20.0).tolist() == naive_movements(angle, 20.0, 5.0)


def test_arms_that_rise_once_a_minute_are_accepted_and_twice_above_60_are_not():
    once, twice = np.zeros(60), np.zeros(60)
    once[10:14], twice[10:14], twice[30:34] = 70.0, 70.0, 70.0
    never, start_s = np.zeros(60, bool), np.arange(60.0)
    for angle, n in ((once, 0), (twice, 8)):
        assert (verdicts(angle, never, start_s, "left_arm") == 2).sum() == n


def test_arms_in_zone_2_become_too_much_ten_times_a_minute():
    start_s, never = np.arange(60.0), np.zeros(60, bool)
    for times, n in ((9, 0), (10, 10)):
        angle = np.zeros(60)
        angle[np.arange(times) * 5] = 40.0
        assert (verdicts(angle, never, start_s, "right_arm") == 2).sum() == n
