from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from emulator.fitting.preprocessing import jumps, repaired
from emulator.geometry import sphere
from emulator.motion import (
    IMPOSSIBLE_M_PER_S,
    MotionSet,
    glitch,
    heading_rad,
    motion_from_positions,
    stretches,
    top_speed_m_per_s,
    turn,
)
from emulator.recordings import read_motions
from emulator.recordings.npz import read_npz
from emulator.skeleton import standard_skeleton
from emulator.synthetic.choreography import TASKS, Body, joints_m, pose_at
from emulator.synthetic.tasks import make
from tests.recordings import recording

BODY = standard_skeleton()


def standing(n_times=30, rng=None):
    """A body-like cloud that wobbles: (T, J, 3), hips along y, looking along x."""
    rng = np.random.default_rng(5) if rng is None else rng
    rest = rng.normal(scale=0.3, size=(BODY.n_joints, 3)) + np.array([0, 0, 1.0])
    rest[BODY.root] = [0, 0, 0.95]
    rest[BODY.index("left_hip")] = [0, 0.1, 0.9]
    rest[BODY.index("right_hip")] = [0, -0.1, 0.9]
    phase = np.linspace(0, 2 * np.pi, n_times)[:, None, None]
    limbs = np.arange(BODY.n_joints)[:, None]
    return rest + np.where(limbs == BODY.root, 0, 0.02) * np.sin(phase + limbs)


def walked(n_times=30):
    """The same on a curved path: turned by 4 rad in all and carried away."""
    yaw = 1.0 + np.linspace(0, 4.0, n_times)
    carried = np.stack([np.linspace(2, 5, n_times), np.linspace(-1, 3, n_times), np.zeros(n_times)], axis=-1)
    return turn(standing(n_times), yaw[:, None]) + carried[:, None, :], yaw


def motion(positions, worker="w1", trial="1", **more):
    return motion_from_positions(BODY, positions, 50.0, worker=worker, trial=trial, **more)


def test_a_body_that_looks_along_y_has_heading_of_a_quarter_turn():
    rest = standing()
    rest[:, BODY.index("left_hip")], rest[:, BODY.index("right_hip")] = [-0.1, 0, 0.9], [0.1, 0, 0.9]
    assert np.allclose(heading_rad(BODY, rest), np.pi / 2)


def test_heading_is_unwrapped_past_a_half_turn():
    positions, yaw = walked()
    wobble = heading_rad(BODY, standing())
    assert np.allclose(heading_rad(BODY, positions), yaw + wobble, atol=1e-12)


def test_heading_is_bridged_while_the_hip_line_stands_upright():
    positions, _ = walked()
    upright = positions.copy()
    for hip, side in (("left_hip", 1), ("right_hip", -1)):
        upright[10:14, BODY.index(hip)] = upright[10:14, BODY.root] + np.array([0, 0, 0.1 * side])
    assert np.abs(heading_rad(BODY, upright) - heading_rad(BODY, positions))[10:14].max() < 0.1
    for hip, side in (("left_hip", 1), ("right_hip", -1)):
        upright[:, BODY.index(hip)] = upright[:, BODY.root] + np.array([0, 0, 0.1 * side])
    with pytest.raises(ValueError, match="never level"):
        heading_rad(BODY, upright)


def test_world_positions_come_back():
    positions, _ = walked()
    assert np.abs(motion(positions).positions_m(world=True, rigid=False) - positions).max() < 1e-9


def test_world_positions_of_a_rigid_body_come_back_without_its_stretch():
    positions, _ = walked()
    rigid = motion(positions).positions_m(world=True)
    assert np.abs(motion(rigid).positions_m(world=True) - rigid).max() < 1e-9


def test_posture_forgets_place_heading_size_and_bone_lengths():
    positions, _ = walked()
    plain = motion(positions)
    elsewhere = motion(1.7 * turn(positions, 2.0) + np.array([5.0, -3.0, 0.0]))
    assert np.abs(elsewhere.directions - plain.directions).max() < 1e-12
    lengths = np.random.default_rng(2).uniform(0.1, 0.6, BODY.n_bones)
    reshaped = motion(BODY.positions(BODY.directions(positions), lengths, positions[:, 0]))
    assert np.abs(reshaped.directions - plain.directions).max() < 1e-12
    assert np.allclose(reshaped.bone_length_m, lengths)


def test_side_channels_begin_at_zero_and_follow_the_body():
    positions, _ = walked()
    made = motion(positions)
    assert made.yaw_rad[0] == 0 and made.root_m[0, :2].tolist() == [0, 0]
    assert made.yaw_rad[-1] == pytest.approx(4.0, abs=1e-9)
    assert made.root_m[-1, 2] == pytest.approx(positions[-1, 0, 2])
    assert np.linalg.norm(made.root_m[-1, :2]) == pytest.approx(
        np.linalg.norm((positions[-1, 0] - positions[0, 0])[:2])
    )
    assert made.duration_s == pytest.approx(29 / 50)


def test_a_jump_of_a_marker_is_a_glitch():
    positions = standing()
    assert glitch(positions, 50.0) == ""
    positions[12, 3] += [0.4, 0, 0]
    assert "20" in glitch(positions, 50.0)[:30] and "m/s" in glitch(positions, 50.0)
    positions[12, 3] = np.nan
    assert glitch(positions, 50.0) == "positions are missing"


def made_set():
    rows = [("w10", 1), ("w2", 0), ("w2", 1), ("w1", 1)]
    motions = [motion(standing(20 + i), w, str(i), covariates={"cov_correct": c}) for i, (w, c) in enumerate(rows)]
    return MotionSet("wobble", tuple(motions))


def test_workers_come_in_natural_order():
    made = made_set()
    assert made.workers == ("w1", "w2", "w10")
    assert made.worker_index.tolist() == [2, 1, 1, 0]
    assert np.allclose(made.duration_s, np.arange(19, 23) / 50)


def test_where_takes_text_and_predicates_and_remembers_the_text():
    made = made_set()
    right = made.where("cov_correct == 1 and worker != w1")
    assert [m.trial for m in right.motions] == ["0", "2"]
    assert right.selection == "cov_correct == 1 and worker != w1"
    assert [m.trial for m in made.where(lambda m: m.duration_s > 0.41).motions] == ["2", "3"]
    assert [m.trial for m in made.subset([3, 0]).motions] == ["3", "0"]


def test_an_empty_set_is_refused_with_its_selection():
    with pytest.raises(ValueError, match=r"no repetition is left.*cov_correct == 5"):
        made_set().where("cov_correct == 5")


def test_marks_must_fit_their_names():
    with pytest.raises(ValueError, match="w1/1 has 2 marks, not 1"):
        MotionSet("wobble", (motion(standing(), mark_s=[0.1, 0.2]),), mark_names=("turn",))


def test_shapes_are_checked():
    made = motion(standing())
    with pytest.raises(ValueError, match=r"yaw_rad must be \(30,\), found \(29,\)"):
        type(made)(**{**made.__dict__, "yaw_rad": made.yaw_rad[1:]})


@pytest.fixture(scope="module")
def walked_along():
    return joints_m(pose_at(TASKS["walk"], np.linspace(0, 1, 60), np.zeros(4)), Body(1.7, 1.0, 1.0))


def test_turning_takes_x_towards_y_and_leaves_height():
    assert np.allclose(turn(np.array([1.0, 0, 5.0]), np.pi / 2), [0, 1, 5])


def test_turning_back_is_the_way_back():
    vectors = np.random.default_rng(0).normal(size=(4, 5, 3))
    assert np.allclose(turn(turn(vectors, 0.7), -0.7), vectors)


def test_the_heading_turns_with_the_body(walked_along):
    skeleton = standard_skeleton()
    straight, turned = heading_rad(skeleton, walked_along), heading_rad(skeleton, turn(walked_along, 1.1))
    assert np.abs(straight).max() < 0.3
    assert np.allclose(turned - straight, 1.1)


def test_the_heading_of_a_full_turn_goes_on_past_pi(walked_along):
    yaw = np.linspace(0, 3 * np.pi, len(walked_along))
    found = heading_rad(standard_skeleton(), turn(walked_along, yaw[:, None]))
    assert found[-1] - found[0] == pytest.approx(3 * np.pi, abs=0.3)


def test_where_the_hip_line_stands_upright_the_heading_is_bridged(walked_along):
    skeleton = standard_skeleton()
    lying = walked_along.copy()
    left, right = (skeleton.index(f"{side}_hip") for side in ("left", "right"))
    middle = (lying[20:30, left] + lying[20:30, right]) / 2
    up = np.array([0, 0, 0.1])
    lying[20:30, left], lying[20:30, right] = middle + up, middle - up
    found = heading_rad(skeleton, lying)
    assert np.all(np.isfinite(found)) and np.abs(found[20:30]).max() < 0.3


def test_a_body_whose_hips_are_never_level_has_no_heading(walked_along):
    skeleton = standard_skeleton()
    upright = walked_along.copy()
    upright[:, skeleton.index("left_hip"), :2] = upright[:, skeleton.index("right_hip"), :2] = upright[:, 0, :2]
    upright[:, skeleton.index("left_hip"), 2] = upright[:, 0, 2] + 0.1
    upright[:, skeleton.index("right_hip"), 2] = upright[:, 0, 2] - 0.1
    with pytest.raises(ValueError, match="never level"):
        heading_rad(skeleton, upright)


def test_the_top_speed_is_that_of_the_fastest_joint():
    positions = np.zeros((3, 2, 3))
    positions[2, 1, 0] = 0.5
    assert top_speed_m_per_s(positions, 50.0) == pytest.approx(25.0)


def test_a_marker_that_jumps_and_positions_that_are_missing_are_told(walked_along):
    assert glitch(walked_along, 30.0) == ""
    jumped = walked_along.copy()
    jumped[7, 3, 2] += 1.0
    assert f"at most {IMPOSSIBLE_M_PER_S:g}" in glitch(jumped, 30.0)
    jumped[7, 3, 2] = np.nan
    assert glitch(jumped, 30.0) == "positions are missing"


def test_stretches_stop_one_beyond_their_last_frame():
    assert stretches(np.array([True, False, True, True, False, False, True])) == [(0, 1), (2, 4), (6, 7)]
    assert stretches(np.zeros(3, bool)) == [] and stretches(np.zeros(0, bool)) == []


@given(st.lists(st.booleans(), max_size=40))
def test_stretches_hold_all_true_frames_and_no_other(true):
    inside = [frame for start, stop in stretches(np.array(true, bool)) for frame in range(start, stop)]
    assert inside == [frame for frame, is_true in enumerate(true) if is_true]


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
