"""BVH written and read again: every joint where it was.

Rotations as three turns, and the turns that bring one thing to another.
"""

from dataclasses import replace

import numpy as np
import pytest

from emulator.recordings.amc import read_amc
from emulator.recordings.bvh import BvhFile, read_bvh, read_bvh_file
from emulator.recordings.bvh_write import (
    ORDERS,
    best_turn,
    bvh_of,
    calm_order,
    euler_deg,
    least_turn,
    write_bvh,
    write_bvh_file,
)
from emulator.recordings.take import Take
from emulator.skeleton import standard_skeleton
from emulator.synthetic.tasks import make
from tests.emulator.recordings.bvh_texts import ARM, random_file, written
from tests.naive import naive_turn
from tests.recordings import raw, recording


def again(take, folder):
    """The take written and read again, joints in their old order."""
    write_bvh(take, folder / "again.bvh")
    read = read_bvh(folder / "again.bvh", unit_m=0.01, up="y")
    names = take.names if isinstance(take, Take) else take.skeleton.names
    order = [read.names.index(name) for name in names]
    parents = [order.index(p) if p >= 0 else -1 for p in (read.parents[j] for j in order)]
    return replace(read, names=names, parents=tuple(parents), positions_m=read.positions_m[:, order])


def bones_m(take):
    children = [j for j, parent in enumerate(take.parents) if parent >= 0]
    return np.linalg.norm(
        take.positions_m[:, children] - take.positions_m[:, [take.parents[j] for j in children]], axis=2
    )


def assert_same_file(one: BvhFile, other: BvhFile):
    assert (one.names, one.parents, one.channels, one.end_parents) == (
        other.names,
        other.parents,
        other.channels,
        other.end_parents,
    )
    assert one.frame_time_s == other.frame_time_s
    for name in ("offsets", "end_offsets", "values"):
        assert np.array_equal(getattr(one, name), getattr(other, name))


@pytest.mark.parametrize("seed", range(4))
def test_a_file_comes_back_to_the_bit(tmp_path, seed):
    text = ARM if seed == 0 else random_file(np.random.default_rng(seed))[0]
    file = read_bvh_file(written(tmp_path, text))
    write_bvh_file(file, tmp_path / "b.bvh")
    assert_same_file(file, read_bvh_file(tmp_path / "b.bvh"))


def test_the_bandai_file_comes_back_to_the_bit(tmp_path):
    file = read_bvh_file(raw("bandai_raise_up_right_hand_normal_001.bvh"))
    write_bvh_file(file, tmp_path / "b.bvh")
    assert_same_file(file, read_bvh_file(tmp_path / "b.bvh"))


def test_the_same_take_gives_the_same_bytes(tmp_path):
    motion = make("lift", 1, 1)[0].motions[0]
    for name in "ab":
        write_bvh(motion, tmp_path / f"{name}.bvh")
    assert (tmp_path / "a.bvh").read_bytes() == (tmp_path / "b.bvh").read_bytes()


@pytest.mark.parametrize("task", ["reach", "lift", "walk"])
def test_a_made_motion_comes_back_with_its_bones(tmp_path, task):
    motion = make(task, 1, 1)[0].motions[0]
    take = again(motion, tmp_path)
    assert np.abs(take.positions_m - motion.positions_m(world=True)).max() < 1e-7
    assert np.ptp(bones_m(take), axis=0).max() < 1e-7
    assert take.rate_hz == pytest.approx((len(motion.time_s) - 1) / motion.duration_s, rel=1e-9)
    assert take.parents == motion.skeleton.parents


def test_recorded_takes_come_back(tmp_path):
    amc = read_amc(raw("HDM_bd_depositFloorR_001_120.amc"))
    for take in (amc, read_bvh(raw("bandai_raise_up_right_hand_normal_001.bvh"))):
        assert np.abs(again(take, tmp_path).positions_m - take.positions_m).max() < 1e-7
    assert np.ptp(bones_m(again(amc, tmp_path)), axis=0).max() < 1e-7


def test_bones_that_breathe_come_back_too(tmp_path):
    from emulator import read_motions

    motion = read_motions(recording("uiprmd_deep_squat")).motions[0]
    places = motion.positions_m(world=True, rigid=False)
    take = Take(motion.skeleton.names, motion.skeleton.parents, places, 50.0)
    assert np.ptp(bones_m(take), axis=0).max() > 0.005
    assert np.abs(again(take, tmp_path).positions_m - places).max() < 1e-7


def tumbling(rng, n_frames=40):
    """A body whose every bone points anywhere, as no body can."""
    skeleton = standard_skeleton()
    directions = rng.normal(size=(n_frames, skeleton.n_bones, 3))
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    places = skeleton.positions(directions, rng.uniform(0.05, 0.5, skeleton.n_bones), rng.normal(size=(n_frames, 3)))
    return Take(skeleton.names, skeleton.parents, places, 30.0)


def test_any_posture_comes_back(tmp_path):
    take = tumbling(np.random.default_rng(0))
    assert np.abs(again(take, tmp_path).positions_m - take.positions_m).max() < 1e-7


def test_opposite_and_upside_down_bones_come_back(tmp_path):
    up = np.array([0, 0, 1.0])
    chain = np.array([[0 * up, up, 2 * up, 3 * up], [0 * up, up, 0 * up, up], [0 * up, -up, -2 * up, -up]])
    take = Take(("pelvis", "spine", "neck", "head"), (-1, 0, 1, 2), chain, 10.0)
    assert np.abs(again(take, tmp_path).positions_m - chain).max() < 1e-7


def test_joints_on_one_spot_and_hips_in_one_line_come_back(tmp_path):
    rng = np.random.default_rng(1)
    side = rng.normal(size=(5, 3))
    root = rng.normal(size=(5, 3))
    places = np.stack([root, root + side, root - side, root], axis=1)
    take = Take(("a", "b", "c", "d"), (-1, 0, 0, 1), places - 0.0, 10.0)
    assert np.abs(again(take, tmp_path).positions_m - places).max() < 1e-7


def test_a_rigid_body_needs_no_position_channels_below_the_root(tmp_path):
    rng = np.random.default_rng(2)
    shape = rng.normal(size=(6, 3))
    turns = np.array([naive_turn("x", a) @ naive_turn("y", 2 * a) @ naive_turn("z", 30) for a in range(0, 170, 7)])
    places = np.einsum("tab,jb->tja", turns, shape)
    file = bvh_of(Take(tuple("abcdef"), (-1, 0, 0, 0, 3, 3), places, 10.0), 0.01)
    assert [len(channels) for channels in file.channels] == [6, 3, 3, 3, 3, 3]


def test_squatting_knees_do_not_turn_at_random(tmp_path):
    from emulator import read_motions

    for motion in read_motions(recording("hdm05_squat_once")).motions[:3]:
        write_bvh(motion, tmp_path / "a.bvh")
        file = read_bvh_file(tmp_path / "a.bvh")
        turns = [name.endswith("rotation") for channels in file.channels for name in channels]
        assert np.abs(np.diff(file.values[:, turns], axis=0)).max() < 20


def test_the_rest_posture_of_named_joints_is_a_t():
    motion = make("reach", 1, 1)[0].motions[0]
    take = Take(motion.skeleton.names, motion.skeleton.parents, motion.positions_m(world=True), 50.0)
    file = bvh_of(take, 0.01)
    offset = {name: v / np.linalg.norm(v) for name, v in zip(file.names, file.offsets) if np.any(v)}
    assert np.allclose(offset["left_elbow"], [1, 0, 0]) and np.allclose(offset["right_wrist"], [-1, 0, 0])
    assert np.allclose(offset["left_knee"], [0, -1, 0]) and np.allclose(offset["head"], [0, 1, 0])


def test_what_cannot_be_written_is_told(tmp_path):
    take = tumbling(np.random.default_rng(0), 3)
    holed = take.positions_m.copy()
    holed[1, 4] = np.nan
    for wrong, said in (
        (replace(take, parents=None), "markers have no bones"),
        (replace(take, positions_m=holed), "joint 'head' has no place at frame 1; fill gaps first"),
        (replace(take, parents=(-1, -1, *take.parents[2:])), "found 2 roots, expected one"),
        (replace(take, parents=(-1, 2, 1, *take.parents[3:])), "joints that do not hang on the root"),
    ):
        with pytest.raises(ValueError, match=said):
            write_bvh(wrong, tmp_path / "no.bvh")
    with pytest.raises(OSError, match=r"missing/no\.bvh"):
        write_bvh(take, tmp_path / "missing" / "no.bvh")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("order", [*ORDERS, "XYZ", "YXZ", "YZX"])
def test_angles_give_the_rotation_back(order):
    rng = np.random.default_rng(3)
    angles = np.concatenate([rng.uniform(-180, 180, (50, 3)), [[10, 90, 20], [0, -90, 0], [30, 90 - 1e-6, 5]]])
    turns = np.array([np.linalg.multi_dot([naive_turn(a.lower(), v) for a, v in zip(order, row)]) for row in angles])
    found = euler_deg(turns, order)
    back = np.array([np.linalg.multi_dot([naive_turn(a.lower(), v) for a, v in zip(order, row)]) for row in found])
    assert np.abs(back - turns).max() < 1e-7


def test_a_knee_bent_to_a_right_angle_is_told_in_another_order():
    bent = np.array([naive_turn("x", angle) for angle in range(0, 140, 5)])
    assert calm_order(bent[:4]) == "ZXY" and calm_order(bent) != "ZXY"


def test_turns_bring_what_they_should_where_they_should():
    rng = np.random.default_rng(4)
    start, end = rng.normal(size=(2, 60, 3))
    start, end = (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (start, end))
    end[:3] = -start[:3]
    end[3] = start[3]
    turns = least_turn(start, end)
    assert np.allclose(np.einsum("tab,tb->ta", turns, start), end, atol=1e-12)
    assert np.allclose(np.linalg.det(turns), 1)
    least = np.arctan2(np.linalg.norm(np.cross(start, end), axis=1), np.sum(start * end, axis=1))
    assert np.allclose(np.trace(turns, axis1=1, axis2=2), 1 + 2 * np.cos(least))
    shape = rng.normal(size=(3, 3))
    assert np.allclose(best_turn(shape, np.einsum("tab,cb->tca", turns, shape)), turns, atol=1e-9)


def test_angles_do_not_jump_where_they_pass_half_a_turn():
    around = np.array([naive_turn("z", angle) for angle in range(0, 800, 40)])
    assert np.allclose(euler_deg(around)[:, 0], np.arange(0, 800, 40))
