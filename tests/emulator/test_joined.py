"""Motions one after another: times exact, speed and posture continuous, feet that stay, nothing changed elsewhere."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from emulator.composite.joining import JoinError, joined, most_gap_rad, posture_gap_rad
from emulator.motion import motion_from_positions
from emulator.skeleton import Skeleton
from emulator.synthetic.tasks import make

RATE_HZ = 50.0


@pytest.fixture(scope="module")
def moves():
    """One repetition of each, all by the first of the same made people."""
    return {task: make(task, 1, 1, seed=3)[0].motions[0] for task in ("reach", "pick", "carry", "place", "walk")}


@pytest.fixture(scope="module")
def kit(moves):
    parts = [moves[task] for task in ("reach", "pick", "carry", "place")]
    return joined(parts), parts


def cut(motion, frame):
    positions = motion.positions_m()
    return [
        motion_from_positions(motion.skeleton, some, RATE_HZ, worker="w", trial="t")
        for some in (positions[: frame + 1], positions[frame:])
    ]


def speeds(motion):
    """(T - 1, B, 3) how fast directions change, radians a second."""
    return np.diff(motion.directions, axis=0) / np.diff(motion.time_s)[:, None, None]


def test_joining_one_motion_is_the_motion(moves):
    assert joined([moves["reach"]]) is moves["reach"]


def test_durations_add_up_exactly(kit):
    whole, parts = kit
    assert whole.duration_s == np.cumsum([part.duration_s for part in parts])[-1]


def test_marks_are_shifted_by_what_went_before_and_by_nothing_else(kit):
    whole, parts = kit
    starts = np.concatenate([[0], np.cumsum([part.duration_s for part in parts])[:-1]])
    assert np.array_equal(whole.mark_s, np.concatenate([s + p.mark_s for s, p in zip(starts, parts)]))


@pytest.mark.parametrize("frame", [20, 40, 60])
@pytest.mark.parametrize("task", ["reach", "walk"])
def test_the_halves_of_a_motion_joined_are_the_motion(moves, task, frame):
    motion = moves[task]
    again = joined(cut(motion, frame), bone_length_m=motion.bone_length_m)
    assert np.abs(again.positions_m(world=True) - motion.positions_m()).max() < 1e-12


def test_joining_is_associative_where_motions_are_longer_than_two_blends(moves):
    a, b, c = (moves[task] for task in ("pick", "carry", "place"))
    left, right, flat = joined([joined([a, b]), c]), joined([a, joined([b, c])]), joined([a, b, c])
    for other in (left, right):
        assert np.abs(other.positions_m() - flat.positions_m()).max() < 1e-12
        assert np.allclose(other.mark_s, flat.mark_s, atol=1e-12)


def test_outside_the_blends_nothing_changes_but_place_and_heading(kit):
    whole, parts = kit
    start, at = 0, 0.0
    for part in parts:
        inside = (part.time_s > 0.3 + 1e-9) & (part.time_s < part.duration_s - 0.3 - 1e-9)
        rows = start + np.flatnonzero(inside)
        assert np.abs(whole.directions[rows] - part.directions[inside]).max() < 1e-12
        assert np.abs(np.diff(whole.yaw_rad[rows]) - np.diff(part.yaw_rad[inside])).max() < 1e-12
        assert np.allclose(whole.time_s[rows], at + part.time_s[inside], atol=1e-12)
        start, at = start + len(part.time_s) - 1, at + part.duration_s


def test_steps_of_the_root_outside_the_blends_are_as_they_were(moves):
    a, b = moves["walk"], moves["carry"]
    whole = joined([a, b], bone_length_m=a.bone_length_m)
    inside = np.flatnonzero((a.time_s > 0) & (a.time_s < a.duration_s - 0.31))
    assert np.abs(whole.root_m[inside] - a.root_m[inside]).max() < 1e-12


def test_directions_stay_unit(kit):
    assert np.abs(np.linalg.norm(kit[0].directions, axis=-1) - 1).max() < 1e-12


def test_the_jump_of_speed_at_a_seam_is_no_larger_than_within_its_motions(kit):
    whole, parts = kit
    frame = 0
    for before, after in pairwise(parts):
        frame += len(before.time_s) - 1
        jump = np.linalg.norm(speeds(whole)[frame] - speeds(whole)[frame - 1], axis=-1).max()
        usual = max(np.linalg.norm(np.diff(speeds(p), axis=0), axis=-1).max() for p in (before, after))
        assert jump <= usual


def test_without_easing_the_same_seam_does_jump(moves):
    """The control: what the join takes away."""
    a, b = moves["pick"], moves["carry"]
    posture_jump = np.linalg.norm(b.directions[0] - a.directions[-1], axis=-1).max() * RATE_HZ
    assert posture_jump > 3 * np.linalg.norm(speeds(joined([a, b])), axis=-1)[len(a.time_s) - 8 :][:16].max()


def test_planted_feet_do_not_slide_at_a_join(moves):
    whole = joined([moves["reach"], moves["pick"], moves["reach"]], bone_length_m=moves["reach"].bone_length_m)
    for foot in ("left_ankle", "right_ankle", "left_toe", "right_toe"):
        way = whole.positions_m()[:, whole.skeleton.index(foot), :2]
        assert np.linalg.norm(way - way[0], axis=-1).max() < 0.01


def test_the_next_motion_goes_on_where_the_last_looks(moves):
    walk = moves["walk"]
    bend = replace(walk, yaw_rad=np.linspace(0, np.pi / 2, len(walk.time_s)))
    whole = joined([bend, walk])
    gone = whole.root_m[-1] - whole.root_m[len(walk.time_s) - 1]
    assert gone[1] == pytest.approx(walk.root_m[-1, 0], abs=0.02) and abs(gone[0]) < 0.05


def test_bones_are_the_first_motion_s_or_as_asked(moves):
    a, b = moves["reach"], replace(moves["pick"], bone_length_m=1.1 * moves["pick"].bone_length_m, stretch=None)
    assert np.array_equal(joined([a, b]).bone_length_m, a.bone_length_m)
    tall = joined([a, b], bone_length_m=b.bone_length_m)
    assert np.array_equal(tall.bone_length_m, b.bone_length_m)
    assert tall.root_m[0, 2] > 1.05 * a.root_m[0, 2]


def test_postures_too_far_apart_are_refused_with_place_found_and_expected(moves):
    a = moves["reach"]
    flipped = a.directions.copy()
    hand = a.skeleton.bone_names.index("right_wrist")
    flipped[:, hand] *= -1
    b = replace(a, directions=flipped, trial="r9")
    assert posture_gap_rad(a, b) > most_gap_rad(a, b)
    with pytest.raises(
        JoinError, match=r"seam 2 \(w1/r1 -> w1/r9\): the bone to right_wrist is 1[78]\d degrees away, exp"
    ):
        joined([a, a, b])


def test_all_wrong_seams_are_said_at_once(moves):
    a = moves["reach"]
    other = Skeleton((*a.skeleton.names[:-1], "right_heel"), a.skeleton.parents)
    b = replace(a, skeleton=other)
    with pytest.raises(JoinError) as caught:
        joined([a, b, a, b])
    assert str(caught.value).count("also right_heel") == 2


def test_nothing_and_no_time_are_refused(moves):
    with pytest.raises(JoinError, match="found no motions, expected one or more"):
        joined([])
    with pytest.raises(JoinError, match="blend_s: found 0, expected positive seconds"):
        joined([moves["reach"]], blend_s=0)


def test_motions_shorter_than_a_blend_can_be_joined(moves):
    pieces = cut(moves["reach"], 6)
    whole = joined([pieces[0], pieces[0], pieces[1]])
    assert np.isfinite(whole.positions_m()).all() and len(whole.time_s) == 12 + len(pieces[1].time_s)
