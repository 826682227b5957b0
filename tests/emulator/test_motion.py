import numpy as np
import pytest

from emulator.motion import MotionSet, glitch, heading_rad, motion_from_positions, turn
from emulator.skeleton import standard_skeleton

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
