import numpy as np
import pytest

from opsim.report.plot.body import TORSO_PART as TORSO
from opsim.report.plot.body import body, body_parts, outer_tangents
from tests.opsim.ergonomics.bodies import standing
from tests.opsim.report.test_posture_picture import SKELETON


def seen(turn_deg):
    """A standing body as seen from an angle about the vertical, 0 from straight ahead: pixels of 10 mm."""
    angle = np.deg2rad(turn_deg)
    x, y, z = standing().T
    near, across = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    return np.stack([100 * across, 200 - 100 * z, near], axis=1)


def order(turn_deg):
    table = body(SKELETON)
    return [part.joint for part in body_parts(table, seen(turn_deg), seen(turn_deg), 0.1)]


def test_all_parts_are_there_once_and_the_head_twice():
    """Of 20 bones 4 tie the torso; its shape and the disc of the head come besides, and the neck's bone ends there."""
    joints = order(30)
    assert len(joints) == 20 - 4 + 2 and joints.count(TORSO) == 1
    assert joints.count(SKELETON.names.index("head")) == 2


def test_the_near_arm_is_drawn_after_the_torso_and_the_far_one_before():
    left, right = (SKELETON.names.index(f"{side}_elbow") for side in ("left", "right"))
    for turn_deg, near, far in ((90, left, right), (-90, right, left)):
        joints = order(turn_deg)
        assert joints.index(far) < joints.index(TORSO) < joints.index(near)


def test_tangents_touch_both_discs_square_to_their_radii():
    a, b = np.array([0.0, 0.0]), np.array([5.0, 1.0])
    on_a, on_b, from_b, back = outer_tangents(a, b, 2.0, 1.0)
    for start, end in ((on_a, on_b), (back, from_b)):
        assert np.linalg.norm(start - a) == pytest.approx(2.0) and np.linalg.norm(end - b) == pytest.approx(1.0)
        assert (
            (end - start) @ (start - a)
            == pytest.approx(0, abs=1e-12)
            == pytest.approx((end - start) @ (end - b), abs=1e-12)
        )


def test_a_disc_inside_another_has_no_tangents():
    assert outer_tangents(np.zeros(2), np.array([0.5, 0.0]), 2.0, 1.0).shape == (0, 2)
