"""What slides and what does not."""

import numpy as np
import pytest

from emulator.cyclic.contacts import Legs, foot_skate_m, path_from_contacts, shares, stand_on, wanting_m
from emulator.motion import stretches
from emulator.skeleton import standard_skeleton
from emulator.synthetic.walking import make_walks

SKELETON = standard_skeleton()


@pytest.fixture(scope="module")
def take():
    return make_walks(1, 1, seed=2)[0].takes[0]


def test_feet_carried_along_slide_as_far_as_they_are_carried(take):
    carried = take.positions_m + np.linspace(0, 1, take.n_frames)[:, None, None] * np.array([0.0, 2.0, 0.0])
    slid = foot_skate_m(carried, take.contact)
    runs = [b - a for side in (0, 1) for a, b in stretches(take.contact[:, side])]
    assert slid == pytest.approx(2.0 / (take.n_frames - 1) * (np.array(runs) - 1), rel=1e-6)


def test_a_foot_that_rolls_over_its_toe_does_not_slide():
    n = 20
    positions = np.zeros((n, SKELETON.n_joints, 3))
    angle = np.linspace(0.3, 1.2, n)
    toe, ankle = SKELETON.index("left_toe"), SKELETON.index("left_ankle")
    positions[:, toe] = [1.0, 0.1, 0.02]
    positions[:, ankle] = positions[:, toe] + 0.16 * np.stack([-np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    assert foot_skate_m(positions, np.tile([True, False], (n, 1))).max() == 0


def test_shares_add_to_one_and_go_from_the_old_foot_to_the_new():
    contact = np.array([[1, 1]] * 3 + [[1, 0]] * 3 + [[1, 1]] * 3 + [[0, 1]] * 3 + [[0, 0]] * 2, bool)
    share = shares(contact)
    assert np.allclose(share.sum(axis=1), 1)
    assert np.all(np.diff(share[3:10, 1]) >= 0)
    assert np.array_equal(share[-1], [0, 1])


def test_a_path_from_feet_that_all_stand_stays(take):
    still = np.repeat(take.positions_m[:1] - take.positions_m[:1, :1], 30, axis=0)
    assert np.abs(path_from_contacts(still, np.ones((30, 2), bool))).max() == 0


def test_legs_reach_their_ankles_with_bones_of_the_same_length(take):
    legs = Legs.of(SKELETON)
    joints = take.positions_m
    bone_m = dict(zip(SKELETON.bones, SKELETON.bone_lengths(joints)[0]))
    ankles = np.stack([joints[:, leg[2]] for leg in legs.joints], axis=1)
    feet = np.stack([joints[:, leg[3]] - joints[:, leg[2]] for leg in legs.joints], axis=1)
    feet /= np.linalg.norm(feet, axis=-1, keepdims=True)
    moved = ankles + np.array([0.03, 0.01, 0.02])
    stood = stand_on(joints, moved, feet, legs, bone_m)
    assert np.abs(stood[:, [leg[2] for leg in legs.joints]] - moved).max() < 1e-9
    assert np.ptp(SKELETON.bone_lengths(stood), axis=0).max() < 1e-9


def test_hips_come_down_for_feet_too_far_away(take):
    legs = Legs.of(SKELETON)
    joints = take.positions_m[:40]
    bone_m = dict(zip(SKELETON.bones, SKELETON.bone_lengths(joints)[0]))
    ankles = np.stack([joints[:, leg[2]] for leg in legs.joints], axis=1) - [0.0, 0.0, 0.05]
    feet = np.stack([joints[:, leg[3]] - joints[:, leg[2]] for leg in legs.joints], axis=1)
    feet /= np.linalg.norm(feet, axis=-1, keepdims=True)
    assert wanting_m(joints, ankles, legs, bone_m).max() > 0.03
    stood = stand_on(joints, ankles, feet, legs, bone_m)
    assert np.abs(stood[:, [leg[2] for leg in legs.joints]] - ankles).max() < 1e-9
    assert np.all(stood[:, 0, 2] < joints[:, 0, 2])
