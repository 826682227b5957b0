from dataclasses import replace

import numpy as np
import pytest

from emulator.fitting.preprocessing import jumps, repaired
from emulator.geometry import sphere
from emulator.motion import MotionSet
from emulator.recordings import read_motions
from emulator.recordings.npz import read_npz
from emulator.synthetic.tasks import make
from tests.recordings import recording

LIFTS = make("lift", 2, 2, seed=1)[0]


def with_directions(directions, motion):
    return MotionSet("lift", (replace(motion, directions=directions),), LIFTS.mark_names)


def test_a_sound_set_is_left_as_it_is():
    assert repaired(LIFTS) is LIFTS


def test_a_jump_is_found_where_it_was_put_and_bridged_within_a_degree():
    motion = LIFTS.motions[0]
    directions = motion.directions.copy()
    directions[40:44, 5] = sphere.normalise(directions[40:44, 5] + [0.3, 0.9, 0.1])
    mended = repaired(with_directions(directions, motion))
    assert mended.motions[0].directions is not directions
    assert np.degrees(sphere.angle(mended.motions[0].directions, motion.directions)).max() < 1.0
    assert "left_elbow jumps by" in mended.notes[-1] and "at frames 40 to 43; bridged" in mended.notes[-1]


def test_the_callers_arrays_are_left_alone():
    motion = LIFTS.motions[0]
    directions = motion.directions.copy()
    directions[40, 5] *= -1
    before = directions.copy()
    repaired(with_directions(directions, motion))
    assert np.array_equal(directions, before)


def test_what_leaves_and_does_not_come_back_is_no_jump():
    step = np.zeros((100, 1, 3))
    step[50:] = 1.0
    assert jumps(step, 50.0) == []
    back = step.copy()
    back[55:] = 0.0
    assert jumps(back, 50.0) == [(0, 50, 54, pytest.approx(np.sqrt(3)))]
    late = step.copy()
    late[65:] = 0.0
    assert jumps(late, 50.0) == []


def test_fast_but_smooth_movement_is_no_jump():
    angle = np.pi / 2 * np.sin(np.linspace(0, 12 * np.pi, 200))  # up to 15 rad/s at 50 Hz
    swing = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=-1)[:, None]
    assert jumps(swing, 50.0) == []


def test_two_jumps_of_one_bone_are_two():
    values = np.zeros((100, 1, 1))
    values[20:22], values[70] = 1.0, -2.0
    assert [(first, last) for _, first, last, _ in jumps(values, 50.0)] == [(20, 21), (70, 70)]


@pytest.mark.parametrize("name", ["deep_squat", "side_lunge", "shoulder_scaption", "inline_lunge"])
def test_nothing_is_mended_in_the_recorded_exercises(name):
    motions = read_motions(recording(f"uiprmd_{name}"), where=None)
    assert repaired(motions) is motions


def test_the_known_marker_fault_of_a_recorded_squat_is_found():
    motions = read_npz(recording("hdm05_squat_once"), None, glitches="keep")
    notes = [note for note in repaired(motions).notes if "bridged" in note]
    assert notes == ["dg/026: right_toe jumps by 1.55 rad at frame 50; bridged"]


def test_uneven_frames_give_the_posture_of_their_time():
    motion = LIFTS.motions[0]
    bent_s = motion.duration_s * (motion.time_s / motion.duration_s) ** 1.3
    place = np.interp(bent_s, motion.time_s, np.arange(len(bent_s), dtype=float))
    low = np.minimum(place.astype(int), len(bent_s) - 2)
    directions = sphere.between(motion.directions[low], motion.directions[low + 1], (place - low)[:, None])
    uneven = replace(motion, directions=directions, time_s=bent_s)
    even = repaired(MotionSet("lift", (uneven,), LIFTS.mark_names))
    assert np.ptp(np.diff(even.motions[0].time_s)) < 1e-12 and "uneven in time" in even.notes[0]
    assert np.degrees(sphere.angle(even.motions[0].directions, motion.directions)).max() < 0.5


def test_copies_and_still_ones_are_noted_and_kept():
    motion = LIFTS.motions[0]
    still = replace(LIFTS.motions[1], directions=np.repeat(motion.directions[:1], len(LIFTS.motions[1].time_s), 0))
    noted = repaired(replace(LIFTS, motions=(motion, motion, still)))
    assert len(noted) == 3
    assert noted.notes[:2] == (
        "1 of 3 repetitions do not move, their own clock is kept: w1/r2",
        "copies of one recording, all used: w1/r1 of w1/r1",
    )
