import numpy as np
import pytest

from emulator.motion import IMPOSSIBLE_M_PER_S, glitch, heading_rad, top_speed_m_per_s, turn
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import TASKS, Body, joints_m, pose_at


@pytest.fixture(scope="module")
def walked():
    return joints_m(pose_at(TASKS["walk"], np.linspace(0, 1, 60), np.zeros(4)), Body(1.7, 1.0, 1.0))


def test_turning_takes_x_towards_y_and_leaves_height():
    assert np.allclose(turn(np.array([1.0, 0, 5.0]), np.pi / 2), [0, 1, 5])


def test_turning_back_is_the_way_back():
    vectors = np.random.default_rng(0).normal(size=(4, 5, 3))
    assert np.allclose(turn(turn(vectors, 0.7), -0.7), vectors)


def test_the_heading_turns_with_the_body(walked):
    skeleton = standard_skeleton()
    straight, turned = heading_rad(skeleton, walked), heading_rad(skeleton, turn(walked, 1.1))
    assert np.abs(straight).max() < 0.3
    assert np.allclose(turned - straight, 1.1)


def test_the_heading_of_a_full_turn_goes_on_past_pi(walked):
    yaw = np.linspace(0, 3 * np.pi, len(walked))
    found = heading_rad(standard_skeleton(), turn(walked, yaw[:, None]))
    assert found[-1] - found[0] == pytest.approx(3 * np.pi, abs=0.3)


def test_where_the_hip_line_stands_upright_the_heading_is_bridged(walked):
    skeleton = standard_skeleton()
    lying = walked.copy()
    left, right = (skeleton.index(f"{side}_hip") for side in ("left", "right"))
    middle = (lying[20:30, left] + lying[20:30, right]) / 2
    up = np.array([0, 0, 0.1])
    lying[20:30, left], lying[20:30, right] = middle + up, middle - up
    found = heading_rad(skeleton, lying)
    assert np.all(np.isfinite(found)) and np.abs(found[20:30]).max() < 0.3


def test_a_body_whose_hips_are_never_level_has_no_heading(walked):
    skeleton = standard_skeleton()
    upright = walked.copy()
    upright[:, skeleton.index("left_hip"), :2] = upright[:, skeleton.index("right_hip"), :2] = upright[:, 0, :2]
    upright[:, skeleton.index("left_hip"), 2] = upright[:, 0, 2] + 0.1
    upright[:, skeleton.index("right_hip"), 2] = upright[:, 0, 2] - 0.1
    with pytest.raises(ValueError, match="never level"):
        heading_rad(skeleton, upright)


def test_the_top_speed_is_that_of_the_fastest_joint():
    positions = np.zeros((3, 2, 3))
    positions[2, 1, 0] = 0.5
    assert top_speed_m_per_s(positions, 50.0) == pytest.approx(25.0)


def test_a_marker_that_jumps_and_positions_that_are_missing_are_told(walked):
    assert glitch(walked, 30.0) == ""
    jumped = walked.copy()
    jumped[7, 3, 2] += 1.0
    assert f"at most {IMPOSSIBLE_M_PER_S:g}" in glitch(jumped, 30.0)
    jumped[7, 3, 2] = np.nan
    assert glitch(jumped, 30.0) == "positions are missing"
