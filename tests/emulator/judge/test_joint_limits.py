import numpy as np
import pytest

from emulator.judge.joint_limits import (
    LIMITS_DEG,
    joint_angles_deg,
    plausibility,
    plausibility_rows,
    recorded_positions_m,
    standing_deg,
)
from emulator.skeleton import CANONICAL, Skeleton, standard_skeleton
from emulator.synthetic.tasks import make

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


def still(n_times=11, **moved):
    return np.repeat(standing(**moved)[None], n_times, axis=0)


def test_one_who_stands_does_nothing_wrong():
    found = plausibility(SKELETON, [still()], np.array([1.0]))
    assert set(found.outside) == set(LIMITS_DEG) and not any(found.outside.values()) and found.frames_outside == 0
    assert found.speed_m_per_s.tolist() == [0] and found.skate_cm.tolist() == [0]


def test_a_knee_bent_backwards_in_half_of_the_frames_is_a_quarter_of_the_knees():
    positions = still(10)
    positions[5:, SKELETON.index("left_ankle")] = [0.2, 0.1, 0.5 - 0.2 * np.sqrt(3)]
    found = plausibility(SKELETON, [positions], np.array([1.0]))
    assert found.outside["knee flexion"] == 0.25 and np.isclose(found.beyond_deg["knee flexion"], 20)


def test_a_frame_is_outside_once_however_many_joints_are():
    positions = still(10)
    for side, at in (("left", slice(5, 10)), ("right", slice(4, 7))):
        sign = 1 if side == "left" else -1
        positions[at, SKELETON.index(f"{side}_ankle")] = [0.2, 0.1 * sign, 0.5 - 0.2 * np.sqrt(3)]
    found = plausibility(SKELETON, [positions, still(10)], np.ones(2))
    assert found.frames_outside == 6 / 20 and found.outside["knee flexion"] == 8 / 40


def test_speed_is_the_way_between_frames_over_their_time():
    positions = still(11)
    positions[6:, SKELETON.index("left_hand"), 0] += 0.1
    assert np.allclose(plausibility(SKELETON, [positions, still()], np.array([2.0, 1.0])).speed_m_per_s, [0.5, 0])


def test_a_foot_that_slides_skates_and_one_that_steps_does_not():
    slid, stepped = still(11), still(11)
    feet = [SKELETON.index("left_ankle"), SKELETON.index("left_toe")]
    way = np.linspace(0, 0.4, 11)[:, None]
    slid[:, feet, 0] += way
    stepped[:, feet, 0] += way
    stepped[1:-1, feet, 2] += 0.2
    found = plausibility(SKELETON, [slid, stepped], np.ones(2))
    assert np.allclose(found.skate_cm, [20, 0])  # 40 cm by two of the four joints


def test_limits_count_from_standing():
    stooped = still(neck=[0.0, 0.15, 1.45])
    bent = still(neck=[0.2 * np.tan(np.radians(-30)), 0, 1.5])
    assert np.isclose(standing_deg(SKELETON, [bent])["trunk flexion"], -30)
    strict, fair = (plausibility(SKELETON, [bent], np.ones(1), zero) for zero in (None, standing_deg(SKELETON, [bent])))
    assert strict.outside["trunk flexion"] == strict.frames_outside == 1
    assert fair.outside["trunk flexion"] == fair.frames_outside == 0
    assert plausibility(SKELETON, [stooped], np.ones(1)).outside["trunk side bend"] == 1


def test_rows_set_the_emulated_beside_the_recorded():
    rows = plausibility_rows(*(plausibility(SKELETON, [still()], np.ones(1)) for _ in range(2)))
    assert len(rows) == len(LIMITS_DEG) + 3 and all(emulated == recorded for _, _, emulated, recorded in rows)


def test_recorded_positions_are_at_even_times_from_first_to_last_frame():
    motions, _ = make("reach", n_workers=2, n_repetitions=2)
    positions = recorded_positions_m(motions, 31)
    assert positions.shape == (len(motions), 31, motions.skeleton.n_joints, 3)
    assert np.allclose(positions[0, [0, -1]], motions.motions[0].positions_m()[[0, -1]])


def test_unequal_numbers_are_refused():
    with pytest.raises(ValueError, match="1 performances and 2"):
        plausibility(SKELETON, [still()], np.ones(2))
