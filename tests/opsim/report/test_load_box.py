import re

import numpy as np
import pytest

from opsim.report.plot.posture import load_box
from tests.opsim.ergonomics.bodies import standing
from tests.opsim.report.test_posture_picture import SKELETON, without


def seen(points):
    """From straight ahead, a pixel a centimetre."""
    points = np.asarray(points, float)
    return np.stack([100 * points[..., 1], 100 - 100 * points[..., 2], points[..., 0]], axis=-1)


def edges_px(load_kg, body=None, skeleton=SKELETON):
    """Left, right, upper and lower edge of the box."""
    ((_, svg),) = load_box(standing() if body is None else body, skeleton, load_kg, seen)
    x, y = np.array(re.findall(r"(-?\d+\.\d) (-?\d+\.\d)", svg), float).T
    return x.min(), x.max(), y.min(), y.max()


def test_a_box_of_its_mass_is_held_between_the_hands():
    """8.1 kg at 300 kg/m3: 0.027 m3, 0.3 m long; the hands' middle lies at y = 0, z = 0.76 m."""
    assert edges_px(8.1) == pytest.approx((-15, 15, 24 - 15, 24 + 15), abs=0.11)


def test_boxes_are_never_too_small_or_too_large_to_be_seen():
    assert np.ptp(edges_px(0.001)[2:]) == pytest.approx(12, abs=0.11)
    assert np.ptp(edges_px(900.0)[2:]) == pytest.approx(45, abs=0.11)


def test_nothing_is_drawn_of_no_load():
    assert load_box(standing(), SKELETON, 0.0, seen) == []


def hands_at(left, right):
    body = standing().copy()
    for hand, place in (("left_hand", left), ("right_hand", right)):
        body[SKELETON.names.index(hand)] = place
    return body


def test_a_box_reaches_from_hand_to_hand_where_both_are_level():
    """Hands at y = 0.3 and -0.3: 0.6 m between them; as high as its mass says, 0.3 m."""
    assert edges_px(8.1, hands_at((0.3, 0.3, 1.0), (0.3, -0.3, 1.0))) == pytest.approx((-30, 30, -15, 15), abs=0.11)


@pytest.mark.parametrize("other", [(0.3, -0.3, 1.6), (0.3, -0.9, 1.1), (-0.4, -0.3, 1.0001)])
def test_a_box_never_floats_between_hands_that_cannot_hold_it_both(other):
    """The left hand is lower, at y = 0.3: the box, 0.3 m long, hangs in it, its top at 1 m."""
    assert edges_px(8.1, hands_at((0.3, 0.3, 1.0), other)) == pytest.approx((15, 45, 0, 30), abs=0.11)
    mirrored = hands_at((other[0], -other[1], other[2]), (0.3, -0.3, 1.0))
    assert edges_px(8.1, mirrored) == pytest.approx((-45, -15, 0, 30), abs=0.11)


def test_wrists_hold_it_where_there_are_no_hands_and_nobody_without():
    names, body = without("hand")
    assert np.mean(edges_px(8.1, body, names)[2:]) == pytest.approx(15, abs=0.11)
    names, body = without("hand", "wrist")
    assert load_box(body, names, 8.1, seen) == []
