import numpy as np
import pytest

from emulator.judge.joint_limits import LIMITS_DEG, joint_angles_deg
from emulator.skeleton import CANONICAL, Skeleton, standard_skeleton

SKELETON = standard_skeleton()
_MIDDLE = {"pelvis": 1.0, "spine": 1.15, "chest": 1.3, "neck": 1.5, "head": 1.65}


def standing(**moved):
    """A body upright, looking along x, arms and legs straight down; joints given by name are put elsewhere."""
    place = {name: np.array([0.0, 0.0, height]) for name, height in _MIDDLE.items()}
    for side, y in (("left", 1.0), ("right", -1.0)):
        heights = {"shoulder": 1.45, "elbow": 1.15, "wrist": 0.9, "hand": 0.8}
        heights |= {"hip": 0.95, "knee": 0.5, "ankle": 0.1, "toe": 0.0}
        for joint, height in heights.items():
            wide = 0.2 if joint in ("shoulder", "elbow", "wrist", "hand") else 0.1
            place[f"{side}_{joint}"] = np.array([0.15 if joint == "toe" else 0.0, y * wide, height])
    place |= {name: np.asarray(at, float) for name, at in moved.items()}
    return np.stack([place[name] for name in CANONICAL])


def angles(**moved):
    return joint_angles_deg(SKELETON, standing(**moved))


def test_standing_is_zero():
    for name, found in angles().items():
        assert np.allclose(found, 0, atol=1e-6), name
    assert set(angles()) == set(LIMITS_DEG)


@pytest.mark.parametrize(
    ("name", "moved", "expected"),
    [
        ("elbow flexion", {"left_wrist": [0.25, 0.2, 1.15]}, [90, 0]),
        ("knee flexion", {"left_ankle": [-0.4, 0.1, 0.5]}, [90, 0]),
        ("knee flexion", {"right_ankle": [0.2, -0.1, 0.5 - 0.2 * np.sqrt(3)]}, [0, -30]),
        ("hip flexion", {"right_knee": [0.45, -0.1, 0.95]}, [0, 90]),
        ("hip flexion", {"left_knee": [-0.45, 0.1, 0.5]}, [-45, 0]),
        ("hip abduction", {"left_knee": [0, 0.55, 0.5]}, [45, 0]),
        ("hip abduction", {"right_knee": [0, -0.55, 0.5]}, [0, 45]),
        ("shoulder extension", {"left_elbow": [-0.3, 0.2, 1.15]}, [45, 0]),
        ("trunk flexion", {"neck": [0.2, 0, 1.5]}, [45]),
        ("trunk side bend", {"neck": [0, 0.2, 1.5]}, [45]),
        ("neck flexion", {"head": [-0.15, 0, 1.65]}, [-45]),
    ],
)
def test_one_joint_moved_by_a_known_angle(name, moved, expected):
    assert np.allclose(angles(**moved)[name], expected, atol=1e-6)


def test_a_raised_arm_and_a_thigh_to_the_side_have_no_such_angle():
    assert np.isnan(angles(left_elbow=[-0.1, 0.2, 1.75])["shoulder extension"][0])
    assert np.isnan(angles(left_knee=[0, 0.55, 0.95])["hip flexion"][0])


def test_turning_moving_and_growing_the_body_changes_no_angle():
    rng = np.random.default_rng(0)
    body = standing() + 0.05 * rng.normal(size=(21, 3))
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    one, other = joint_angles_deg(SKELETON, body), joint_angles_deg(SKELETON, 1.3 * body @ turn.T + 2.0)
    assert all(np.allclose(one[name], other[name], atol=1e-6) for name in one)


def test_a_skeleton_without_knees_is_refused():
    with pytest.raises(ValueError, match="no joint"):
        joint_angles_deg(Skeleton(("pelvis", "spine"), (-1, 0)), np.zeros((2, 3)))
