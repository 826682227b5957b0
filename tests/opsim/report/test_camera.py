import numpy as np
import pytest

from opsim.report.plot.body import FLOOR_M, LIFT_RAD, Camera, camera_of
from tests.made_cards import SKELETON, cards

FRONT = Camera(0, False, (0.0, 0.0), 1.0, 2.0)


def bodies(**more):
    return [card.positions_m for card in cards(2, **more)]


def test_who_looks_along_x_sees_y_to_the_right_and_z_up():
    across, high, _ = FRONT.see(np.array([[0.0, 0.5, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]), np.zeros(2)).T
    assert across == pytest.approx([0.5, 0.0, 0.0])
    assert high[1] - high[2] == pytest.approx(np.cos(LIFT_RAD)) and high[0] == high[2]


def test_what_comes_nearer_is_nearer_and_lower():
    near, far = FRONT.see(np.array([[0.5, 0.0, 1.0], [-0.5, 0.0, 1.0]]), np.zeros(2))
    assert near[2] > far[2] and near[1] < far[1]


@pytest.mark.parametrize("travel_m", [0.0, 3.0])
@pytest.mark.parametrize("turn_deg", [-180, -90, 0, 45])
def test_every_joint_and_the_floor_below_it_is_in_the_picture_from_everywhere(travel_m, turn_deg):
    shown = bodies(travel_m=travel_m)
    seen_by = camera_of(shown, SKELETON)
    camera = Camera(turn_deg, seen_by.follow, seen_by.middle_m, seen_by.wide_m, seen_by.tall_m)
    top_m = 2 * camera.wide_m * camera.height_per_width
    for joints in np.concatenate(shown):
        middle = joints[SKELETON.parents.index(-1), :2] if camera.follow else np.array(camera.middle_m)
        below = np.concatenate([joints[:, :2], np.full((len(joints), 1), FLOOR_M)], axis=1)
        seen = camera.see(np.concatenate([joints, below]), middle)
        assert np.abs(seen[:, 0]).max() < camera.wide_m and seen[:, 1].min() > 0 and seen[:, 1].max() < top_m


def test_who_walks_is_followed_and_who_does_not_is_not():
    assert camera_of(bodies(travel_m=2.0), SKELETON).follow and not camera_of(bodies(), SKELETON).follow


def test_the_view_is_one_for_all_and_does_not_depend_on_their_order():
    shown = bodies()
    assert camera_of(shown, SKELETON).as_dict() == camera_of(shown[::-1], SKELETON).as_dict()


def test_a_skeleton_without_hips_is_looked_at_from_a_side():
    handle = type("Handle", (), {"names": ("grip", "tip"), "parents": (-1, 0)})
    assert camera_of([np.zeros((4, 2, 3))], handle).turn_deg == 30
