import numpy as np

from emulator.model.decoding import RootChannel
from emulator.model.emulator import SCHEMES, MotionEmulator
from emulator.model.feet import on_its_feet
from emulator.skeleton import Skeleton
from tests.emulator.fitted import made, motions_of, recorded


def foot_travel_m(positions, skeleton):
    """How far the lower ankle slides, summed over the frames (T, J, 3) in which the same one stays the lower."""
    ankles = positions[:, [skeleton.index("left_ankle"), skeleton.index("right_ankle")]]
    low = ankles[..., 2].argmin(axis=1)
    step = np.linalg.norm(np.diff(ankles[..., :2], axis=0), axis=-1)
    return step[np.arange(len(step)), low[1:]][low[1:] == low[:-1]].sum()


def split(motion, channel):
    return channel.forward(motion.directions, motion.bone_length_m, motion.root_m, motion.yaw_rad)


def test_path_and_heading_come_back():
    for motion in (*motions_of("walk").motions[:3], *recorded("side_lunge").motions[:2]):
        channel = RootChannel(motion.skeleton)
        root, yaw = channel.inverse(split(motion, channel), motion.directions, motion.bone_length_m)
        assert np.abs(root - motion.root_m).max() < 1e-10
        assert np.abs(yaw - motion.yaw_rad).max() < 1e-12


def test_feet_of_breathing_bones_stay_where_they_were_recorded_when_the_bones_are_made_rigid():
    for motion in recorded("deep_squat").motions[::10]:
        feet = [motion.skeleton.index(f"{s}_toe") for s in ("left", "right")]
        seen, hung, standing = (
            joints[:, feet, 2].min(axis=1)
            for joints in (motion.positions_m(rigid=False), motion.positions_m(), on_its_feet(motion).positions_m())
        )
        assert np.abs(standing - seen).max() < 0.02 < 0.04 < np.ptp(hung)


def test_the_compiled_way_is_the_numpy_way():
    rng = np.random.default_rng(1)
    for name in ("walk", "lift"):
        motions = motions_of(name).motions[:4]
        channel = RootChannel(motions[0].skeleton, rides=True)
        n_times = min(len(motion.directions) for motion in motions)
        directions = np.stack([motion.directions[:n_times] for motion in motions])
        lengths = np.stack([motion.bone_length_m for motion in motions])
        side = rng.normal(0, 0.2, (4, n_times, 4))
        ours, plain = channel.inverse(side, directions, lengths), channel.inverse_numpy(side, directions, lengths)
        assert np.abs(ours[0] - plain[0]).max() < 1e-12 and np.array_equal(ours[1], plain[1])


def test_feet_explain_nearly_all_of_a_walk():
    motion = motions_of("walk").motions[0]
    slip = split(motion, RootChannel(motion.skeleton, rides=True))[:, :2]
    assert np.ptp(motion.root_m[:, 0]) > 2.0
    assert np.ptp(slip, axis=0).max() < 0.25


def test_longer_legs_make_longer_steps():
    motion = motions_of("walk").motions[0]
    channel = RootChannel(motion.skeleton)
    kept = split(motion, channel)
    way = [channel.inverse(kept, motion.directions, s * motion.bone_length_m)[0][-1, 0] for s in (1.0, 1.2)]
    assert np.isclose(way[1] / way[0], 1.2, rtol=0.03)


def test_no_joint_is_below_the_floor_even_where_the_clearance_says_so():
    motion = motions_of("lift").motions[0]
    channel = RootChannel(motion.skeleton)
    sunk = split(motion, channel) - np.array([0, 0, 0.3, 0])
    root, _ = channel.inverse(sunk, motion.directions, motion.bone_length_m)
    assert motion.skeleton.positions(motion.directions, motion.bone_length_m, root)[..., 2].min() > -1e-12


def test_a_body_without_feet_keeps_its_path():
    skeleton = Skeleton(("pelvis", "chest", "head"), (-1, 0, 1))
    rng = np.random.default_rng(0)
    directions = np.broadcast_to([0.0, 0, 1], (8, 2, 3))
    path = np.concatenate([np.zeros((1, 2)), rng.normal(size=(7, 2))])
    root, channel = np.column_stack([path, np.full(8, 0.9)]), RootChannel(skeleton)
    flat = channel.forward(directions, np.array([0.3, 0.3]), root, np.zeros(8))
    assert np.allclose(channel.inverse(flat, directions, np.array([0.3, 0.3]))[0], root)


def test_drawn_walks_slide_no_more_than_two_centimetres_a_step():
    _, emulator = made("walk")
    drawn = emulator.sample(20, np.random.default_rng(0)).positions_m(n_times=150)
    slides = [foot_travel_m(positions, emulator.skeleton) for positions in drawn]
    assert np.median(slides) / 6 < 0.02


def test_feet_of_drawn_squats_stay_on_the_floor():
    emulator = MotionEmulator.fit(recorded("deep_squat"), scheme=SCHEMES[-1])
    drawn = emulator.sample(30, np.random.default_rng(0)).positions_m()
    feet = [recorded("deep_squat").skeleton.index(f"{s}_{j}") for s in ("left", "right") for j in ("ankle", "toe")]
    lowest = drawn[:, :, feet, 2].min(axis=-1)
    assert np.median(np.ptp(lowest, axis=1)) < 0.01  # 0.08 while rigid bones hung from the recorded root
