import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from opsim.ergonomics.kernels.postures import arctan2_deg

PART = st.floats(-1e6, 1e6).filter(lambda part: abs(part) > 1e-12 or part == 0)


def degrees(opposite, adjacent):
    out = np.empty(len(opposite))
    arctan2_deg(np.array(opposite, float), np.array(adjacent, float), out)
    return out


def test_angles_of_the_eight_ways():
    ways = degrees([0, 1, 1, 1, 0, -1, -1, -1], [1, 1, 0, -1, -1, -1, 0, 1])
    assert np.allclose(ways, [0, 45, 90, 135, 180, -135, -90, -45])


def test_what_has_no_direction_is_nan():
    assert np.isnan(degrees([0, np.nan, 1, np.nan], [0, 1, np.nan, np.nan])).all()


@given(st.lists(st.tuples(PART, PART).filter(any), min_size=1, max_size=40))
@example([(-0.0, -1.0), (0.0, -1.0)])
def test_it_is_the_arc_tangent_of_numpy(pairs):
    opposite, adjacent = np.array(pairs).T
    assert np.allclose(degrees(opposite, adjacent), np.rad2deg(np.arctan2(opposite, adjacent)), rtol=1e-14, atol=1e-13)
