import numpy as np
import pytest

from opsim.report.sections.motions import CARD_RATE_HZ as RATE_HZ
from opsim.report.sections.motions import Card, resampled, staged
from tests.opsim.report.test_strips import NAMES, STANDING, Skeleton

SKELETON = Skeleton()
LEFT_HIP, RIGHT_HIP, TOE = (NAMES.index(name) for name in ("left_hip", "right_hip", "left_ankle"))


def walked(n=51, rate_hz=50.0):
    """A body that goes 0.5 m forward while it lifts its left hand."""
    positions = np.tile(STANDING, (n, 1, 1))
    positions[:, :, 0] += np.linspace(0, 0.5, n)[:, None]
    positions[:, NAMES.index("left_wrist"), 2] += np.sin(np.linspace(0, np.pi, n)) * 0.4
    return positions, rate_hz


def elsewhere(positions, turn_rad=2.1, by=(3.0, -4.0, 0.2)):
    """The same movement at another place of the room, in another heading, on a higher floor."""
    cosine, sine = np.cos(turn_rad), np.sin(turn_rad)
    return positions @ np.array([[cosine, sine, 0], [-sine, cosine, 0], [0, 0, 1]]) + by


def test_place_heading_and_floor_of_the_room_leave_no_trace():
    positions, rate_hz = walked()
    assert np.allclose(staged(elsewhere(positions), rate_hz, SKELETON), staged(positions, rate_hz, SKELETON))


def test_the_first_frame_stands_at_the_origin_on_the_floor_and_looks_along_x():
    shown = staged(elsewhere(walked()[0]), 50.0, SKELETON)
    assert np.allclose(shown[0, 0, :2], 0)
    across = shown[0, LEFT_HIP] - shown[0, RIGHT_HIP]
    assert across[0] == pytest.approx(0, abs=1e-12) and across[1] > 0
    assert shown[..., 2].min(axis=1) == pytest.approx(0, abs=1e-9)


def test_a_jump_of_one_frame_does_not_move_the_floor():
    positions, rate_hz = walked()
    positions[10, TOE, 2] = -0.5
    assert staged(positions, rate_hz, SKELETON)[0, :, 2].min() == pytest.approx(0, abs=1e-9)


def test_the_way_is_kept_as_the_body_went():
    shown = staged(elsewhere(walked()[0]), 50.0, SKELETON)
    assert shown[-1, 0, :2] == pytest.approx([0.5, 0.0])


@pytest.mark.parametrize("rate_hz", [25.0, 50.0, 60.0, 120.0])
def test_frames_lie_on_the_straight_lines_between_recorded_ones(rate_hz):
    time_s = np.arange(round(2 * rate_hz) + 1) / rate_hz
    positions = np.sin(time_s)[:, None, None] * np.ones((1, 2, 3))
    shown = resampled(positions, rate_hz)
    expected = np.interp(np.arange(len(shown)) / RATE_HZ, time_s, np.sin(time_s))
    assert len(shown) == 61 and np.allclose(shown[:, 1, 2], expected)


def test_the_end_is_the_last_recorded_posture_and_never_beyond():
    positions, _ = walked(n=48)
    assert len(resampled(positions, 50.0)) == round(47 / 50 * RATE_HZ) + 1
    assert np.allclose(resampled(positions, 50.0)[-1], positions[-1], atol=0.5 / 30)


def test_a_body_without_hips_keeps_its_heading():
    class Arm:
        names, parents = ("pelvis", "left_elbow"), (-1, 0)

    positions = np.zeros((5, 2, 3))
    positions[:, 1] = [0.3, 0.4, 0.0]
    assert np.allclose(staged(positions, 30.0, Arm())[:, 1], [0.3, 0.4, 0.0])


def test_a_card_knows_how_long_it_lasts():
    assert Card(np.zeros((61, 2, 3)), True, "s1").duration_s == pytest.approx(2.0)
