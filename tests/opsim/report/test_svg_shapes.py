import re

import numpy as np
import pytest

from opsim.report.plot.svg_canvas import disc, path_of, polygon, taper


def numbers(path):
    return [float(number) for number in re.findall(r"-?\d+\.\d", path)]


def test_a_disc_is_two_half_circles():
    path = disc(np.array([10.0, 20.0]), 4.0)
    assert path.count("A") == 2 and numbers(path)[:2] == [14.0, 20.0] == numbers(path)[-2:] and path.endswith("Z")


def test_a_limb_goes_round_its_larger_end_the_long_way():
    """From radius 3 to 1 the outline turns by more than half a circle at the first, less at the second."""
    path = taper(np.zeros(2), np.array([10.0, 0.0]), 3.0, 1.0)
    near_b, near_a = re.findall(r"A(\S+) \S+ 0 (\d) 0", path)
    assert near_b == ("1.0", "0") and near_a == ("3.0", "1")


def test_a_limb_that_points_at_the_viewer_is_a_disc():
    assert taper(np.zeros(2), np.array([0.5, 0.0]), 3.0, 1.0) == disc(np.zeros(2), 3.0)
    assert taper(np.zeros(2), np.array([0.5, 0.0]), 1.0, 3.0) == disc(np.array([0.5, 0.0]), 3.0)


def area(path):
    x, y = np.array(numbers(path)).reshape(-1, 2).T
    return float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)) / 2


def test_corners_run_the_same_way_round_whichever_way_they_were_given():
    corners = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])
    assert area(polygon(corners)) == area(polygon(corners[::-1])) == pytest.approx(-8.0)


def test_shapes_are_told_by_their_kind():
    assert path_of("disc", (np.zeros(2), 1.0)) == disc(np.zeros(2), 1.0)
    assert path_of("inside", np.eye(3, 2)) == polygon(np.eye(3, 2))
    ends = (np.zeros(2), np.ones(2), 0.2, 0.1)
    assert path_of("taper", ends) == taper(*ends)
