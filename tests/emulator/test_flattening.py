"""Bones that turn about, and postures opposite to their base: what is left of them, and what is said."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.geometry import sphere
from emulator.geometry.alignment import align
from emulator.geometry.base_points import NEARLY_OPPOSITE_RAD, ROOM_RAD, base_points
from emulator.geometry.flattening import SIEM
from emulator.geometry.opposite_points import led_around, led_over
from emulator.model.decoding import Decoder, directions_numpy
from emulator.model.reduction import JointPCA
from emulator.synthetic.tasks import make
from tests.emulator.fitted import motions_of, recorded


def postures(rng, *shape):
    return sphere.normalise(np.array([0.2, 0.1, 1.0]) + 0.6 * rng.normal(size=(*shape, 3)))


def test_the_reference_itself_is_the_origin():
    siem = SIEM.fit(postures(np.random.default_rng(0), 30, 5))
    assert np.abs(siem.forward(siem.reference)).max() < 1e-15


def test_a_coordinate_pair_is_as_long_as_the_angle_to_the_reference():
    siem = SIEM(np.array([[0.0, 0, 1], [1.0, 0, 0]]))
    there = np.array([[0.0, np.sin(0.7), np.cos(0.7)], [0.0, 0.0, 1.0]])
    assert np.allclose(np.linalg.norm(siem.forward(there).reshape(2, 2), axis=1), [0.7, np.pi / 2], atol=1e-14)


def test_coordinates_of_the_training_postures_have_mean_zero():
    y = postures(np.random.default_rng(1), 40, 6)
    assert np.abs(SIEM.fit(y).forward(y).mean(axis=0)).max() < 1e-11


def test_forward_and_back_keeps_made_postures_to_1e_12():
    y = postures(np.random.default_rng(2), 7, 50, 20)
    siem = SIEM.fit(y)
    assert np.abs(siem.inverse(siem.forward(y)) - y).max() < 1e-12


def test_back_and_forward_keeps_coordinates_to_1e_12():
    siem = SIEM.fit(postures(np.random.default_rng(3), 9, 20))
    flat = np.random.default_rng(4).uniform(-1.5, 1.5, (11, 40))
    assert np.abs(siem.forward(siem.inverse(flat)) - flat).max() < 1e-12


@pytest.mark.parametrize("name", ["deep_squat", "shoulder_abduction"])
def test_forward_and_back_keeps_aligned_recordings_to_1e_12(name):
    aligned = align([m.directions for m in recorded(name).motions[:12]], max_iterations=2).directions
    siem = SIEM.fit(aligned)
    assert np.abs(siem.inverse(siem.forward(aligned)) - aligned).max() < 1e-12


def test_place_size_and_proportions_do_not_enter():
    motions = motions_of("reach")
    skeleton, position = motions.skeleton, motions.motions[0].positions_m()
    siem = SIEM.fit(motions.motions[0].directions)
    longer = skeleton.bone_lengths(position[0]) * np.linspace(0.8, 1.3, skeleton.n_bones)
    bent = skeleton.positions(skeleton.directions(position), longer, position[:, 0])
    for changed in (position + np.array([3.0, -1.0, 0.5]), 1.7 * position, bent):
        difference = siem.forward(skeleton.directions(changed)) - siem.forward(skeleton.directions(position))
        assert np.abs(difference).max() < 1e-12


def test_a_bone_opposite_to_the_reference_is_refused():
    siem = SIEM(np.array([[0.0, 0, 1]]))
    with pytest.raises(ValueError, match="opposite"):
        siem.forward(np.array([[0.0, 0, -1]]))


LIFT = make("lift", 1, 1, seed=2)[0].motions[0]
N, BONE = len(LIFT.time_s), 8


def turned(frames):
    way = LIFT.directions.copy()
    way[frames, BONE] *= -1
    return replace(LIFT, directions=way)


def steps(motion):
    return sphere.angle(motion.directions[1:], motion.directions[:-1])


USUAL = steps(LIFT).max()
SHORT = {"one": slice(30, 31), "some": slice(30, 34), "the first": slice(0, 3), "the last": slice(-3, None)}


@pytest.mark.parametrize("frames", SHORT.values(), ids=SHORT)
def test_a_few_frames_turned_about_are_left_to_those_beside(frames):
    mended, note = led_over(turned(frames), 0.2)
    others = np.ones(N, bool)
    others[frames] = False
    assert np.array_equal(mended.directions[others], LIFT.directions[others])
    away = sphere.angle(mended.directions[frames, BONE], LIFT.directions[frames, BONE])
    assert away.max() < 4 * USUAL
    assert "right_shoulder turns about" in note
    assert note.endswith("left to the frames beside")


def test_the_note_tells_frames_and_time_of_the_first_turn():
    note = led_over(turned(slice(30, 34)), 0.2)[1]
    assert f"between frames 29 and 30 (at {LIFT.time_s[30]:.2f} s) and 1 times more" in note


def test_a_bone_that_stays_turned_is_led_over_on_two_frames_and_no_step_is_opposite():
    mended, note = led_over(turned(slice(40, None)), 0.2)
    changed = np.flatnonzero((mended.directions != turned(slice(40, None)).directions).any(axis=(1, 2)))
    assert changed.tolist() == [39, 40]
    assert steps(mended).max() == pytest.approx(np.pi / 3, abs=0.1)
    assert "are markers swapped" in note


def test_a_sound_motion_is_the_very_same():
    assert led_over(LIFT, 0.2) == (LIFT, "")
    mended, notes = led_around([LIFT, LIFT])
    assert mended[0] is LIFT
    assert notes == []


def test_a_bone_that_turns_about_all_the_time_is_refused_by_place():
    with pytest.raises(ValueError, match=r"w1/r1: .* right_shoulder turns about between frames 0 and 1 .* no frame"):
        led_over(turned(slice(0, None, 2)), 0.2)


def everywhere(n_frames):
    """The lift with a bone that winds around the whole sphere, from pole to pole."""
    height, turn = np.linspace(1, -1, n_frames), np.linspace(0, 16 * np.pi, n_frames)
    across = np.sqrt(1 - height**2)
    at = np.linspace(0, N - 1, n_frames).round().astype(int)
    way = LIFT.directions[at].copy()
    way[:, BONE] = np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)
    root, yaw = LIFT.root_m[at], LIFT.yaw_rad[at]
    time_s = np.arange(n_frames) / 100.0
    return replace(LIFT, directions=way, root_m=root, yaw_rad=yaw, time_s=time_s, mark_s=LIFT.mark_s[:0], stretch=None)


def test_where_no_base_has_room_the_way_is_led_around_the_opposite_point():
    rng = np.random.default_rng(0)
    turns = [np.linalg.qr(rng.normal(size=(3, 3)))[0] for _ in range(12)]
    crowd = [everywhere(800)] * 12
    crowd = [replace(m, directions=m.directions @ turn) for m, turn in zip(crowd, turns)]
    mended, notes = led_around(crowd)
    base = base_points(np.stack([m.directions[::4] for m in mended]))[1][BONE]
    room = min(np.pi - sphere.angle(np.broadcast_to(base, (800, 3)), m.directions[:, BONE]).max() for m in mended)
    assert room > 0.5 * NEARLY_OPPOSITE_RAD
    far = [sphere.angle(a.directions[:, BONE], b.directions[:, BONE]).max() for a, b in zip(mended, crowd)]
    assert max(far) < 2.5 * NEARLY_OPPOSITE_RAD
    assert any("points every way, opposite to any base point in w1/r1 at" in note for note in notes)


def far_out(n=12, n_times=60):
    """n sequences of three bones; the first of them comes within 0.02 of opposite to its mean for a while."""
    rng = np.random.default_rng(4)
    clock = np.linspace(0, 1, n_times)
    angle = np.where(np.arange(n)[:, None] == 0, 3.12 * np.sin(np.pi * clock) ** 2, 0.3 * np.sin(2 * np.pi * clock))
    sway = 0.2 * np.sin(np.arange(1, n + 1)[:, None] * clock + rng.normal(size=(n, 1)))
    way = np.stack([np.sin(angle) * np.cos(sway), np.sin(angle) * np.sin(sway), np.cos(angle)], axis=-1)
    return np.stack([way, np.roll(way, 1, axis=-1), np.roll(way, 2, axis=-1)], axis=2)


def test_a_posture_far_from_its_base_comes_back_through_the_components_and_both_decoders():
    sequences = far_out()
    siem = SIEM.fit(sequences)
    flat = siem.forward(sequences)
    length = np.linalg.norm(flat.reshape(*flat.shape[:-1], 3, 2), axis=-1)
    assert np.all(siem.reference != base_points(sequences)[0])
    assert np.pi / 2 < length.max() < np.pi - ROOM_RAD + 0.01
    assert np.abs(siem.inverse(flat) - sequences).max() < 1e-12
    posture = JointPCA.fit(flat.reshape(len(flat), -1), len(flat) - 1)
    coefficients = posture.forward(flat.reshape(len(flat), -1))
    place = np.broadcast_to(np.arange(60.0), (len(flat), 60))
    for decoded in (
        Decoder(posture, siem).directions(coefficients, place),
        directions_numpy(posture, siem, coefficients, place),
    ):
        assert np.abs(decoded - sequences).max() < 1e-9
