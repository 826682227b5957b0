"""Feet on the floor: when they stand, and bodies that stand like that."""

from dataclasses import replace

import numpy as np
import pytest

from emulator.model.emulator import MotionEmulator
from emulator.model.feet import Footing, Legs, Stance, bend, on_its_feet, prints, standing, stood, strays
from emulator.motion import turn
from emulator.skeleton import Skeleton
from tests.emulator.fitted import made, motions_of, recorded, shipped
from tests.naive import footing as naive_footing

RATE_HZ = 60.0


def a_step(slip_m=0.0):
    """(joints, legs, stands): a left foot that stands half a second, lifts for half a second, and stands again."""
    skeleton, at = motions_of("walk").skeleton, np.arange(91)
    joints = np.zeros((91, skeleton.n_joints, 3))
    swing = np.clip((at - 30) / 30, 0, 1)
    legs = Legs.of(skeleton)
    for joint in legs.feet[0]:
        joints[:, joint, 0] = 0.7 * swing**2 * (3 - 2 * swing) + slip_m * np.clip(at / 30, 0, 1)
        joints[:, joint, 2] = 0.15 * np.sin(np.pi * swing)
    joints[:, legs.feet[1], 2] = 1.0 + 0.3 * np.sin(at / 3)[:, None]
    return joints, legs, standing(joints, RATE_HZ, legs)


def test_a_foot_stands_before_and_after_its_step_and_one_in_the_air_never_does():
    _, _, stands = a_step()
    assert stands[0, :25].all() and not stands[0, 38:52].any() and stands[0, 66:].all()
    assert not stands[1].any()


def test_prints_are_the_slip_about_the_place_of_the_stance_and_the_height():
    joints, legs, stands = a_step(slip_m=0.03)
    own = prints(joints, np.zeros(91), stands, legs)
    assert np.ptp(own[0, :25, 0]) == pytest.approx(0.025, abs=0.003)
    assert np.abs(np.median(own[0, stands[0], 0])) < 0.02 and not own[0, ~stands[0]].any() and not own[1].any()


def test_a_skeleton_without_toes_has_no_legs_to_stand_on_and_one_without_knees_only_feet():
    assert Legs.of(Skeleton(("pelvis", "chest"), (-1, 0))) is None
    feet = ("left_ankle", "left_toe", "right_ankle", "right_toe")
    assert Legs.of(Skeleton(("pelvis", *feet), (-1, 0, 1, 0, 3))).bones is None


def test_joints_between_ankle_and_toe_are_those_of_the_foot():
    bones = (("pelvis", -1), ("left_ankle", 0), ("left_foot", 1), ("left_toe", 2), ("right_ankle", 0), ("right_toe", 4))
    assert Legs.of(Skeleton(*zip(*bones))).joints.tolist() == [[1, 2, 3], [4, 4, 5]]


def test_a_joint_between_ankle_and_toe_goes_with_its_foot():
    from emulator.kernels.legs import turned_height

    way, rest, by = np.random.default_rng(0).normal(size=(3, 3))
    ankle, was = np.array([1.0, 2.0, 0.5]), (way + rest) / np.linalg.norm(way + rest)
    foot = (was + by) / np.linalg.norm(was + by)
    want = naive_footing.turned(np.array([way, rest]), by)[0, 2]
    assert turned_height(ankle + way, ankle, was, foot) == pytest.approx(want, abs=1e-12)


def of_lift(worker=0):
    """What ``stood`` takes of drawn lifts, with stances of the nearest recordings."""
    emulator = made("lift")[1]
    some = emulator.sample(4, np.random.default_rng(worker))
    clock = np.tile(np.arange(float(emulator.n_times)), (4, 1))
    aligned = emulator.decoder.directions(emulator.scale.raw(some.scores, "posture"), clock)
    root, yaw = emulator.channel.inverse(emulator.root_channel(some.scores), aligned, some.bone_length_m)
    near = emulator.footing.nearest(emulator.scale.raw(some.scores, "posture"))
    leg_m = emulator.channel.leg_m(some.bone_length_m)
    time_s = emulator.warps(some.scores) * emulator.moving_s(some.scores)[:, None]
    stance = emulator.footing.stance(near, leg_m)
    path = np.concatenate([root, yaw[..., None]], axis=-1)
    path = path + 0.02 * np.sin(clock / 9)[..., None]  # feet that would slide and sink
    return emulator, aligned, some.bone_length_m, path, time_s, stance


@pytest.mark.parametrize("worker", [0, 1])
def test_the_compiled_footing_is_the_naive_one(worker):
    emulator, *rest, stance = of_lift(worker)
    feet_m = np.broadcast_to(np.array([[0.09, 0.03], [-1.0, 0.05]]), (4, 2, 2))
    stance = replace(stance, floor_m=np.full(4, -0.001), foot_floor_m=feet_m, stray_m=0.5 * stance.stray_m)
    ours, bends, _ = stood(emulator.skeleton, emulator.legs, *rest, stance)
    for i in range(4):
        one = [values[i] for values in rest]
        want, naive_bends = naive_footing.stood(emulator.skeleton, emulator.legs, *one, stance, i)
        assert np.abs(ours[i] - want).max() < 1e-9 and np.abs(bends[i] - naive_bends).max() < 1e-9


def test_the_compiled_bend_is_the_naive_one_and_bones_keep_their_lengths():
    emulator, aligned, lengths, *_ = of_lift()
    by = np.array([0.03, -0.02, 0.04, -0.1, 0.2, 0.1])
    bends = np.broadcast_to(by, (4, 2, emulator.n_times, 6)).copy()
    place = np.tile(np.arange(float(emulator.n_times)), (4, 1))
    ours = aligned.copy()
    bend(ours, lengths, emulator.legs, place, bends)
    assert np.abs(np.linalg.norm(ours, axis=-1) - 1).max() < 1e-9
    for i, t, (upper, lower) in ((0, 3, emulator.legs.bones[0]), (2, 60, emulator.legs.bones[1])):
        thigh, shank = (lengths[i, b] * aligned[i, t, b] for b in (upper, lower))
        want = naive_footing.bent(thigh, shank, by[:3])
        for bone, vector in zip((upper, lower), want):
            assert np.abs(lengths[i, bone] * ours[i, t, bone] - vector).max() < 1e-9
    for i, t, sole in ((0, 3, emulator.legs.soles[0]), (2, 60, emulator.legs.soles[1])):
        want = naive_footing.turned(lengths[i, sole, None] * aligned[i, t, sole], by[3:])
        assert np.abs(lengths[i, sole, None] * ours[i, t, sole] - want).max() < 1e-9


def test_planted_feet_of_draws_stray_no_farther_than_recorded_ones():
    motions, emulator = made("walk")
    drawn, slips = emulator.sample(12, np.random.default_rng(0)), []
    for joints, seconds in (
        *((m.positions_m(), m.duration_s) for m in motions.motions[:12]),
        *zip(drawn.positions_m(n_times=200), drawn.duration_s),
    ):
        stands = standing(joints, (len(joints) - 1) / seconds, emulator.legs)
        slips.append(np.abs(prints(joints, np.zeros(len(joints)), stands, emulator.legs)[..., :2]).max())
    assert np.median(slips[12:]) < 1.5 * np.median(slips[:12]) + 0.005


def test_feet_that_never_turn_do_not_turn_in_draws():
    emulator, aligned, lengths, path, time_s, stance = of_lift()
    swivelling = aligned.copy()
    clock = np.arange(float(emulator.n_times))
    sole = emulator.legs.soles[0, 0]
    swivelling[:, :, sole] = turn(aligned[:, :, sole], 0.2 * np.sin(clock / 9))
    stance = Stance.on(np.ones_like(stance.stands), np.zeros_like(stance.prints_m[..., :5]), -9.0)
    _, bends, _ = stood(emulator.skeleton, emulator.legs, swivelling, lengths, path, time_s, stance)
    place = np.tile(clock, (4, 1))
    bend(swivelling, lengths, emulator.legs, place, bends)
    yaw = path[:, :, 3]
    level = turn(swivelling[:, :, sole], yaw)
    assert np.ptp(np.arctan2(level[..., 1], level[..., 0]), axis=1).max() < 0.01
    assert np.abs(level[..., 2]).max() < 0.02


def test_a_library_of_before_has_prints_without_directions(tmp_path):
    emulator = made("lift")[1]
    before = replace(emulator, footing=replace(emulator.footing, prints=emulator.footing.prints[..., :3].copy()))
    before.save(tmp_path / "lift.npz")
    again = MotionEmulator.load(tmp_path / "lift.npz")
    assert np.array_equal(again.footing.prints, before.footing.prints)
    some = before.sample(3, np.random.default_rng(0))
    ours, bare = (replace(some, model=model).directions() for model in (again, replace(again, footing=None)))
    soles = again.legs.soles.ravel()
    assert np.abs(ours - bare).max() > 1e-6 and np.abs(ours - bare)[:, :, soles].max() < 1e-12


def two_feet(place_m, stands):
    """(91,) how far a body is off feet 0.4 m apart whose every other joint is at ``place_m``, and its mass."""
    joints, legs, _ = a_step()
    joints[:] = [*place_m, 1.0]
    joints[:, legs.feet[0]], joints[:, legs.feet[1]] = [0.0, 0.0, 0.0], [0.4, 0.0, 0.0]
    return strays(joints, np.repeat(np.array(stands)[:, None], 91, axis=1), legs, 1 / RATE_HZ), legs


def test_a_centre_of_mass_is_as_far_off_its_feet_as_it_is_beside_the_way_between_them():
    far, legs = two_feet((0.2, 0.3), (True, True))
    rest, right = 1 - legs.mass[legs.feet].sum(), legs.mass[legs.feet[1]].sum()
    assert far == pytest.approx(0.3 * rest, abs=1e-9)
    one, _ = two_feet((0.2, 0.3), (True, False))
    assert one == pytest.approx(np.hypot(0.2 * rest + 0.4 * right, 0.3 * rest), abs=0.002)
    assert np.all(two_feet((0.2, 0.3), (False, False))[0] == np.inf)


def test_a_body_off_its_feet_is_moved_over_them_and_its_feet_stay():
    emulator, aligned, lengths, path, time_s, stance = of_lift()
    clock = np.tile(np.arange(float(emulator.n_times)), (4, 1))
    chest = aligned.copy()
    upper = [i for i, name in enumerate(emulator.skeleton.bone_names) if "spine" in name or "chest" in name]
    chest[:, :, upper] = turn(np.array([1.0, 0.0, 0.0]), 0.0)  # bent at a right angle, whatever the draw does
    feet_m, off_m = [], []
    for stray_m in (np.full_like(stance.stray_m, np.inf), np.zeros_like(stance.stray_m)):
        held = replace(stance, stray_m=stray_m)
        moved, bends, _ = stood(emulator.skeleton, emulator.legs, chest, lengths, path, time_s, held)
        bodies = chest.copy()
        bend(bodies, lengths, emulator.legs, clock, bends)
        one = emulator.skeleton.positions(turn(bodies[0], moved[0, :, 3:]), lengths[0], moved[0, :, :3])
        feet_m.append(one[:, emulator.legs.feet])
        off_m.append(strays(one, stance.stands[0], emulator.legs, time_s[0, -1] / (len(one) - 1)))
    assert off_m[0].mean() > 0.03 and off_m[1].mean() < 0.25 * off_m[0].mean()
    assert np.abs(feet_m[1] - feet_m[0])[..., :2].mean() < 0.01


def test_nothing_changes_for_recordings_whose_bones_do_not_breathe():
    motion = motions_of("lift").motions[0]
    still = replace(motion, stretch=None)
    assert on_its_feet(still) is still


def test_recorded_feet_are_kept_when_breathing_bones_are_made_rigid():
    motion = recorded("deep_squat").motions[0]
    legs = Legs.of(motion.skeleton)
    seen, rigid, ours = motion.positions_m(rigid=False), motion.positions_m(), on_its_feet(motion).positions_m()
    stands = standing(seen, 50.0, legs)
    off = [np.abs(p[:, legs.feet[0]] - seen[:, legs.feet[0]])[stands[0]][..., 2].mean() for p in (rigid, ours)]
    assert off[1] < 0.5 * off[0]


@pytest.mark.parametrize("joints", [[0, 1], [0, 0, 1]])
def test_a_saved_footing_is_the_fitted_one(tmp_path, joints):
    emulator = made("walk")[1]
    floors = emulator.footing.foot_floor[:, :, joints]
    emulator = replace(emulator, footing=replace(emulator.footing, foot_floor=floors))
    emulator.save(tmp_path / "walk.npz")
    again = MotionEmulator.load(tmp_path / "walk.npz")
    for name in ("postures", "stands", "prints", "floor", "foot_floor", "strays"):
        assert np.array_equal(getattr(again.footing, name), getattr(emulator.footing, name))
    assert not again.rides


def test_the_nearest_recording_is_the_nearest():
    postures = np.array([[0.0, 0], [3, 0], [0, 4]])
    footing = Footing(postures, np.zeros((3, 2, 5), bool), np.zeros((3, 2, 5, 5)), *(np.zeros(3),) * 3)
    assert footing.nearest(np.array([[0.4, 0.1], [2.0, 0.5], [0.0, 9.0]])).tolist() == [0, 1, 2]


def test_a_draw_faster_than_a_body_is_drawn_in_and_counted_and_its_times_stay():
    _, emulator = made("lift")
    calm = emulator.sample(6, np.random.default_rng(0))
    wild = calm.scores.copy()
    block = emulator.scale.block("posture")
    wild[3, block] += 60.0 * np.random.default_rng(1).normal(size=block.stop - block.start)
    drawn = emulator.performances(wild)
    assert drawn.damped[3] > 0 and calm.damped[3] == 0
    assert np.array_equal(np.delete(drawn.damped, 3), np.delete(calm.damped, 3))
    assert np.array_equal(drawn.duration_s, calm.duration_s) and np.array_equal(drawn.mark_s, calm.mark_s)
    assert drawn._ground.fastest_m_per_s[3] <= emulator.most_m_per_s or drawn.damped[3] == 1.0


def test_a_draw_that_nothing_slows_down_stays_where_it_was_least_fast():
    emulator = replace(made("lift")[1])
    emulator.__dict__["most_m_per_s"] = 0.01
    drawn = emulator.sample(6, np.random.default_rng(0))
    ground, free, mean = drawn._ground, drawn._grounded(np.ones(6)), drawn._grounded(np.zeros(6))
    assert np.all(ground.fastest_m_per_s <= np.minimum(free.fastest_m_per_s, mean.fastest_m_per_s))
    again = drawn._grounded(ground.kept)
    assert np.abs(again.flat - ground.flat).max() < 1e-12 and np.abs(again.control - ground.control).max() < 1e-12


def test_a_draw_stands_like_the_recording_that_it_was_drawn_about_and_a_recording_like_itself():
    """By postures as they are, draws stand like recordings in the middle: noise takes the place of most deviations."""
    model = shipped("walk")
    known, footing, n = model.workforce.smoothed, model.footing, len(model.footing.postures)
    centre, rng = known.means[known.owner] + known.deviations, np.random.default_rng(0)
    draws = np.concatenate([centre + known.reach[:, None] * known.noise.sample(n, rng) for _ in range(10)])
    own, postures = np.tile(np.arange(n), 10), model.scale.raw(draws, "posture")
    assert np.array_equal(footing.nearest(footing.postures, model.whitening), np.arange(n))
    assert np.mean(footing.nearest(postures, model.whitening) == own) > 0.95
    assert np.mean(footing.nearest(postures) == own) < 0.8
    assert np.array_equal(model.performances(draws[:n])._drawn.near, footing.nearest(postures[:n], model.whitening))
