"""How often and how long somebody lifts."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.lifting_pattern import duration_hours, pattern

HOUR_S = 3600.0


@pytest.mark.parametrize(
    ("lifting_min", "recovery_min", "hours"),
    [
        ([60], [np.inf], 1),
        ([61], [np.inf], 2),
        ([120], [np.inf], 2),
        ([121], [np.inf], 8),
        # the manual's own: 45 min of lifting need 54 min of recovery to be of short duration
        ([45, 45], [54, np.inf], 1),
        ([45, 45], [53, np.inf], 2),  # 90 min together; 53 are more than 0.3 x 45
        ([90, 90], [27, np.inf], 2),  # 0.3 x 90 = 27
        ([90, 90], [26, np.inf], 8),  # 180 min together
        ([], [], 1),
    ],
)
def test_durations_by_hand(lifting_min, recovery_min, hours):
    assert duration_hours(np.array(lifting_min) * 60.0, np.array(recovery_min) * 60.0) == hours


def test_lifts_are_counted_over_the_time_of_lifting():
    """A lift of 5 s every 30 s from 0 to 1795 s: 60 lifts in 29.9 min; a pause of over 10 min is none of it."""
    start_s = np.arange(60) * 30.0
    found = pattern(start_s, start_s + 5.0)
    assert (found.minutes, found.hours) == (pytest.approx(1775 / 60), 1)
    both = pattern(np.r_[start_s, 10_000 + start_s], np.r_[start_s + 5, 10_005 + start_s])
    assert both.minutes == pytest.approx(2 * found.minutes)


def test_a_single_lift_is_counted_over_a_quarter_of_an_hour():
    assert pattern(np.array([100.0]), np.array([103.0])).minutes == 15.0


def test_one_lift_every_nine_minutes_is_one_long_period_and_every_eleven_is_many_short_ones():
    for gap_s, hours in ((540.0, 8), (660.0, 1)):
        start_s = np.arange(0.0, 8 * HOUR_S, gap_s)
        assert pattern(start_s, start_s + 5.0).hours == hours


def test_nobody_who_lifts_nothing_lifts_long():
    assert pattern(np.empty(0), np.empty(0)).hours == 1


minutes = st.lists(st.tuples(st.floats(0, 200), st.floats(0, 200)), max_size=6)


@given(minutes, st.floats(1, 3))
def test_more_recovery_never_lengthens_and_more_lifting_never_shortens(periods, times):
    lifting_s, recovery_s = (np.array([60 * p[i] for p in periods]) for i in (0, 1))
    found = duration_hours(lifting_s, recovery_s)
    assert duration_hours(lifting_s, recovery_s * times) <= found <= duration_hours(lifting_s * times, recovery_s)


def lifting(until_min, begin_min=0, every_min=1):
    start_s = np.arange(begin_min, until_min, every_min) * 60.0
    return start_s, start_s + 5.0


@pytest.mark.parametrize("seen_min", [(0, 40), (0, 100), (0, 200), (60, 100)])
def test_the_duration_is_that_of_the_shift_whatever_part_of_it_is_seen(seen_min):
    seen_s = 60.0 * seen_min[0], 60.0 * seen_min[1]
    found = [
        pattern(*lifting(seen_min[1], seen_min[0]), [(0.0, shift_s)], seen_s)
        for shift_s in (HOUR_S * 0.9, 2 * HOUR_S, 8 * HOUR_S)
        if shift_s >= seen_s[1]
    ]
    assert [one.hours for one in found] == [1, 2, 8][3 - len(found) :]
    assert all(one.most_hours == one.hours for one in found)


def test_recovery_that_is_seen_is_in_the_rest_of_the_shift_too():
    """30 min of lifting, 60 of recovery, of which 1.2 x 30 = 36 are enough; 30 of recovery are not (0.3 x 30 are)."""
    for whole_min, hours in ((90, 1), (60, 2)):
        shown = lifting(30)
        assert pattern(*shown, [(0.0, 8 * HOUR_S)], (0.0, 60.0 * whole_min)).hours == hours


def test_who_has_no_shifts_may_go_on_as_long_as_the_table_knows():
    found = pattern(*lifting(40))
    assert (found.hours, found.most_hours, found.columns) == (1, 8, (1, 2, 8))


def test_a_shift_that_is_seen_to_its_end_is_as_it_is_and_so_is_one_in_which_nothing_is_lifted():
    whole = pattern(*lifting(50), [(0.0, HOUR_S)], (0.0, HOUR_S))
    other = pattern(*lifting(50), [(0.0, HOUR_S), (HOUR_S, 9 * HOUR_S)], (0.0, 1.5 * HOUR_S))
    assert whole == other and whole.hours == 1
