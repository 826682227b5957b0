from math import inf

import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.human.fatigue import Schultz

SHARES = st.floats(0.0, 1.0)


@pytest.mark.parametrize(
    ("before", "after", "shift"),
    [(1.0, 0.0, -0.2), (0.0, 1.0, 0.1), (0.75, 0.25, -0.1), (0.25, 0.75, 0.05), (0.5, 0.5, 0.0)],
)
def test_who_holds_others_up_is_faster_by_what_the_buffers_differ(before, after, shift):
    """faster 0.2, slower 0.1: -0.2 * (0.75 - 0.25) = -0.1; 0.1 * (0.75 - 0.25) = 0.05."""
    assert Schultz(faster=0.2, slower=0.1).shift(before, after) == pytest.approx(shift)


@given(before=SHARES, after=SHARES)
def test_neutral_shifts_by_nothing(before, after):
    assert 0.0 + Schultz(faster=0.0, slower=0.0).shift(before, after) == 0.0


@given(before=SHARES, after=SHARES, more=SHARES)
def test_a_fuller_buffer_before_never_makes_slower(before, after, more):
    model = Schultz(faster=0.3, slower=0.2)
    assert model.shift(max(before, more), after) <= model.shift(before, after)


@pytest.mark.parametrize(
    ("waiting", "places", "share"), [(2, 4, 0.5), (9, 4, 1.0), (0, 0, 0.0), (1, 0, 1.0), (5, inf, 0.5), (50, inf, 1.0)]
)
def test_how_full_a_buffer_is(waiting, places, share):
    """A buffer without limit counts as full with ten jobs."""
    assert Schultz(full_at=10).share(waiting, places) == share
