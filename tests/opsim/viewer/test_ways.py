import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.layout import ways
from opsim.scenario.schema import Layout
from opsim.viewer.routes import CORNER_M, Routes, at_m, eased_heading, length_m, smooth, without_doubles, wrapped

POINTS = st.lists(st.tuples(st.integers(-9, 9), st.integers(-9, 9)), min_size=2, max_size=5).map(
    lambda points: without_doubles([(float(x), float(y)) for x, y in points])
)
CORNER = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]])


def test_places_on_a_way():
    assert at_m(CORNER, 1.0)[0] == pytest.approx([1, 0]) and at_m(CORNER, 5.0)[0] == pytest.approx([4, 1])
    assert at_m(CORNER, 99.0)[0] == pytest.approx([4, 3]) and at_m(CORNER, -1.0)[0] == pytest.approx([0, 0])


def test_ways_along_the_axes_lead_around_benches():
    """Every one is as long; with a bench before both ends the way goes up between them."""
    layout = Layout(distance="rectilinear", places={"a": ["0 m", "0 m"], "b": ["4 m", "5 m"]})
    free, around = (Routes(ways(layout), layout, benches) for benches in ([], [(0.0, 0.77), (4.0, 0.77)]))
    assert free.points_m((0.0, 0.0), (4.0, 5.0), 0, 1) == [(0.0, 0.0), (4.0, 0.0), (4.0, 5.0)]
    assert around.points_m((0.0, 0.0), (4.0, 5.0), 0, 1) == [(0.0, 0.0), (2.0, 0.0), (2.0, 5.0), (4.0, 5.0)]


def test_ways_on_paths_pass_the_places_between():
    places = {"a": ["0 m", "0 m"], "b": ["4 m", "0 m"], "c": ["4 m", "3 m"]}
    layout = Layout(distance="paths", places=places, paths=[["a", "b", "c"]])
    found = Routes(ways(layout), layout).points_m((0.0, 0.5), (4.0, 3.0), 0, 2)
    assert found == [(0.0, 0.5), (4.0, 0.0), (4.0, 3.0)]


def test_who_walks_turns_before_and_after_a_corner():
    headings = [at_m(CORNER, 4.0 + past)[1] for past in (-0.5, -CORNER_M / 2, 0.0, CORNER_M / 2, 0.5)]
    assert headings == pytest.approx(np.array([0, 1, 2, 3, 4]) / 4 * np.pi / 2)


@given(POINTS, st.floats(0.0, 1.0))
def test_places_and_headings_change_without_a_jump(points, share):
    way = np.array(points)
    s_m, small_m = share * length_m(points), 1e-7
    one, two = at_m(way, s_m), at_m(way, s_m + small_m)
    assert np.linalg.norm(one[0] - two[0]) <= 1.01 * small_m
    assert abs(wrapped(one[1] - two[1])) < 1e-4 or abs(abs(wrapped(one[1] - two[1])) - np.pi) < 1e-4


def test_walks_begin_and_end_as_one_stood():
    yaw = (np.pi / 2, -np.pi / 2)
    assert eased_heading(0.0, 0.0, 5.0, 5.0, yaw) == pytest.approx(np.pi / 2)
    assert eased_heading(0.0, 5.0, 0.0, 5.0, yaw) == pytest.approx(-np.pi / 2)
    assert eased_heading(0.3, 2.0, 3.0, 5.0, yaw) == 0.3
    assert eased_heading(0.3, 0.0, 5.0, 5.0, (np.nan, np.nan)) == 0.3


@given(st.floats(-50.0, 50.0))
def test_a_turn_is_taken_the_shorter_way_round(angle):
    assert abs(wrapped(angle)) <= np.pi + 1e-4
    assert np.cos(wrapped(angle)) == pytest.approx(np.cos(angle)) and np.sin(wrapped(angle)) == pytest.approx(
        np.sin(angle), abs=1e-9
    )


@pytest.mark.parametrize("angle", [np.pi, -np.pi, np.float32(np.pi), np.float32(-np.pi), 3 * np.pi])
def test_half_turns_go_to_the_left_however_they_are_rounded(angle):
    assert wrapped(float(angle)) == pytest.approx(np.pi)


def test_smooth_goes_from_0_to_1_and_stays_there():
    assert [smooth(share) for share in (-1.0, 0.0, 0.5, 1.0, 2.0)] == [0.0, 0.0, 0.5, 1.0, 1.0]
