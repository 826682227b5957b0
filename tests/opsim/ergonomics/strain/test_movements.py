"""Movements beyond an angle."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.static_holds import Movements, movements


def test_a_movement_begins_beyond_the_edge_and_ends_well_below_it():
    """Up, a little back (17 is within 5 of 20), up again: one; right back to 14, up: another."""
    angle = np.array([0.0, 25.0, 17.0, 25.0, 14.0, 18.0, 21.0, np.nan, 30.0])
    assert np.flatnonzero(movements(angle, 20.0)).tolist() == [1, 6]
    assert movements(np.array([30.0, 30.0]), 20.0).tolist() == [True, False]
    assert movements(np.empty(0), 20.0).size == 0


def naive_movements(angle, beyond, back):
    up, found = False, []
    for value in angle:
        found.append(not up and value > beyond)
        up = True if value > beyond else False if value < beyond - back else up
    return found


courses = st.lists(st.sampled_from([0.0, 14.9, 15.0, 18.0, 20.0, 20.1, 40.0, np.nan]), max_size=40)


@given(courses, st.lists(st.integers(0, 40), max_size=3))
def test_movements_are_the_naive_ones_wherever_a_day_is_cut(angle, cuts):
    expected = naive_movements(angle, 20.0, 5.0)
    assert movements(np.array(angle), 20.0).tolist() == expected
    one = Movements(20.0)
    parts = np.split(np.array(angle), sorted(min(cut, len(angle)) for cut in cuts))
    assert np.concatenate([one.next(part) for part in parts]).tolist() == expected
