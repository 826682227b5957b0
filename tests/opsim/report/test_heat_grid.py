"""Time spread over a floor: none is lost, and it lies where it was spent."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.report.sections.occupancy import HeatGrid as Grid
from opsim.report.sections.occupancy import spread

GRID = Grid(0.0, 5.0, 0.1, (50, 80))
POINTS = st.tuples(st.floats(0, 8), st.floats(0, 5))


@given(st.lists(st.tuples(st.lists(POINTS, min_size=1, max_size=4), st.floats(0, 1e4)), max_size=5), st.floats(0.01, 3))
def test_nothing_is_lost_however_it_is_smoothed(lines, sigma):
    assert spread(GRID, lines, sigma).sum() == pytest.approx(sum(amount for _, amount in lines), abs=1e-6)


def test_a_point_is_a_bell_about_it():
    found = spread(GRID, [(((2.05, 3.05),), 1.0)], 0.4)
    row, column = np.unravel_index(found.argmax(), found.shape)
    assert (row, column) == (19, 20)
    assert found.max() / 0.01 == pytest.approx(1 / (2 * np.pi * 0.4**2), rel=0.01)


def test_a_line_is_even_along_its_length():
    found = spread(GRID, [(((1.0, 2.0), (7.0, 2.0)), 6.0)], 0.2).sum(axis=0)
    assert np.allclose(found[20:60], 0.1, rtol=0.02) and found[:3].sum() < 1e-4
