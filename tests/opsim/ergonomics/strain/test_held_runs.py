"""Marks of held frames made into runs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.strain.static_holds import RunsOf
from tests.opsim.ergonomics.holding import naive_parts


@given(st.lists(st.booleans(), max_size=30), st.integers(0, 30))
def test_runs_do_not_depend_on_where_stretches_are_cut(held, cut):
    held = np.array(held, bool)
    angle, start_s, seconds = np.arange(held.size) * 1.0, np.arange(held.size) * 0.5, np.full(held.size, 0.5)
    found = []
    for edges in ([], [min(cut, held.size)]):
        runs = RunsOf(100.0, 0.1)
        for part in np.split(np.arange(held.size), edges):
            runs.add(0, start_s[part], seconds[part], angle[part], held[part])
        found.append(runs.runs())
    for name in ("start_s", "seconds", "angle_deg"):
        assert getattr(found[0], name) == pytest.approx(getattr(found[1], name))
    assert found[0].seconds.sum() == pytest.approx(0.5 * held.sum())


def runs_of(angle_deg, seconds=1.0, held=True, cuts=()):
    angle, n = np.asarray(angle_deg, float), len(angle_deg)
    lasting, marks = np.full(n, seconds) if np.isscalar(seconds) else np.asarray(seconds), np.full(n, held)
    start_s, runs = np.r_[0.0, np.cumsum(lasting)[:-1]][:n], RunsOf(10.0, 0.5)
    for part in np.split(np.arange(n), sorted(min(cut, n) for cut in cuts)):
        runs.add(0, start_s[part], lasting[part], angle[part], marks[part])
    return runs.runs()


def test_three_holds_one_after_the_other_are_three():
    """25 degrees for 20 s, 70 for 8 s, 25 for 20 s: no hold is at (40 x 25 + 8 x 70) / 48 = 32.5 degrees."""
    found = runs_of([25.0] * 20 + [70.0] * 8 + [25.0] * 20)
    assert found.seconds.tolist() == [20.0, 8.0, 20.0] and found.angle_deg.tolist() == [25.0, 70.0, 25.0]
    assert found.start_s.tolist() == [0.0, 20.0, 28.0]


def test_the_longest_part_within_the_band_is_a_hold_and_not_the_first():
    """3 s at 25, 10 s at 34, 10 s at 40: from the left 13 s and 10 s; the longest is the 20 s from 34 to 40."""
    found = runs_of([25.0] * 3 + [34.0] * 10 + [40.0] * 10)
    assert found.seconds.tolist() == [3.0, 20.0] and found.angle_deg.tolist() == [25.0, 37.0]


def test_a_short_frame_that_is_not_held_is_between_two_holds():
    found = runs_of([30.0] * 60, seconds=0.1, held=np.arange(60) != 30)
    assert found.seconds == pytest.approx([3.0, 2.9])


@given(st.lists(st.sampled_from([25.0, 30.0, 34.0, 36.0, 41.0, 70.0]), max_size=24), st.integers(0, 99), st.data())
def test_holds_are_the_naive_parts_wherever_a_day_is_cut(angle, seed, data):
    lasting = np.random.default_rng(seed).integers(1, 4, len(angle)) * 0.125
    found = runs_of(angle, lasting, cuts=data.draw(st.lists(st.integers(0, 24), max_size=3)))
    spans = naive_parts(angle, list(lasting), 10.0)
    assert found.seconds == pytest.approx([lasting[first:last].sum() for first, last in spans])
    assert found.angle_deg == pytest.approx(
        [np.average(angle[first:last], weights=lasting[first:last]) for first, last in spans]
    )
