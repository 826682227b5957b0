"""Lines along the axes: beside each other, and round what stands in their way where they can."""

from itertools import pairwise

from hypothesis import given
from hypothesis import strategies as st

from opsim.report.plot.floor_plan_lines import Laid, rounded

POINTS = st.tuples(st.integers(0, 60).map(lambda n: 10.0 * n), st.integers(0, 40).map(lambda n: 10.0 * n))


@given(st.lists(st.tuples(POINTS, POINTS, st.floats(1, 13)), max_size=12))
def test_a_line_joins_its_ends_along_the_axes(wanted):
    laid = Laid([], 5.0)
    for start, end, width in wanted:
        corners = laid.line(start, end, width)
        assert corners[0] == start and corners[-1] == end
        assert all(a[0] == b[0] or a[1] == b[1] for a, b in pairwise(corners))
        assert rounded(corners).startswith(f"M{start[0]:.1f} {start[1]:.1f}") if len(corners) > 1 else start == end


def test_the_same_way_twice_lies_beside_itself():
    laid = Laid([], 5.0)
    first, second = (laid.line((0.0, 0.0), (100.0, 0.0), 4.0) for _ in range(2))
    assert first == [(0.0, 0.0), (100.0, 0.0)] and second != first


def test_of_two_corners_the_one_without_a_station_is_taken():
    corners = Laid([(100.0, 0.0)], 5.0).line((0.0, 0.0), (100.0, 80.0), 2.0)
    assert (0.0, 80.0) in corners
