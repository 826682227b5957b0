"""What slides and what does not.

States without labels: bearing feet from their speeds, phases of a cycle from a chain over the latent velocity.
"""

import numpy as np
import pytest

from emulator.cyclic.contacts import (
    Chain,
    Legs,
    contact_of,
    contact_of_state,
    contact_speed_m_per_s,
    foot_skate_m,
    found_states,
    path_from_contacts,
    shares,
    single_support,
    stand_on,
    state_of_contact,
    wanting_m,
    without_flicker,
)
from emulator.cyclic.latent import PoseLatent, poses_of
from emulator.motion import stretches
from emulator.recordings.npz import read_recording
from emulator.skeleton import standard_skeleton
from emulator.synthetic.walking import make_walks
from tests.made.rowing import RATE_HZ, made_rowing
from tests.naive import naive_chain
from tests.recordings import recording

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


YES, NO = True, False


def test_contact_without_labels_agrees_with_labels_on_each_of_119_walks():
    takes = read_recording(recording("bandai2_walk")).takes
    agreed = [np.mean(contact_of(take) == take.contact) for take in takes]
    assert len(takes) == 119 and min(agreed) > 0.9 and np.mean(agreed) > 0.98


def test_the_best_threshold_parts_two_kinds_of_speed():
    rng = np.random.default_rng(0)
    speed = np.concatenate([rng.lognormal(-3, 0.4, 500), rng.lognormal(0.5, 0.3, 300)])
    assert 0.15 < contact_speed_m_per_s(speed) < 0.8


def test_who_only_stands_has_both_feet_on_the_floor():
    standing = np.tile(np.random.default_rng(1).normal(size=(1, 21, 3)), (60, 1, 1))
    standing += np.random.default_rng(2).normal(0, 1e-4, standing.shape)
    assert contact_of(standing, standard_skeleton(), 30.0).all()


def test_positions_need_skeleton_and_rate():
    with pytest.raises(ValueError, match="skeleton and the rate"):
        contact_of(np.zeros((5, 21, 3)))


def test_flickers_go_and_ends_stay():
    bears = np.array([1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0], bool)
    assert without_flicker(bears, 2).astype(int).tolist() == [1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 0]
    assert np.array_equal(without_flicker(bears, 1), bears)


def test_contacts_and_states_are_two_words_for_one_thing():
    contact = np.array([[NO, NO], [YES, NO], [NO, YES], [YES, YES]])
    assert state_of_contact(contact).tolist() == [0, 1, 2, 3]
    assert np.array_equal(contact_of_state(state_of_contact(contact)), contact)


def test_of_two_feet_the_one_that_came_down_last_bears():
    contact = np.array([[YES, YES], [YES, NO], [YES, YES], [YES, YES], [NO, YES], [NO, NO], [YES, NO]])
    assert single_support(contact).tolist() == [1, 1, 2, 2, 2, 2, 1]


def test_the_phases_of_made_rowing_are_found():
    takes, truth = made_rowing()
    poses = [poses_of(take, standard_skeleton(), RATE_HZ) for take in takes]
    latent = PoseLatent.fit(poses, components=3)
    found = np.concatenate(found_states([latent.forward(one) for one in poses], 3, RATE_HZ))
    truth = np.concatenate(truth)
    assert np.mean((found == 0) == (truth == 0)) > 0.95
    moving = (found > 0) & (truth > 0)
    same = np.mean(found[moving] == truth[moving])
    assert max(same, 1 - same) > 0.95


def test_one_state_is_found_without_looking():
    assert found_states([np.zeros((4, 2))], 1, 30.0)[0].tolist() == [0, 0, 0, 0]


def test_smoothing_and_path_are_those_over_all_paths():
    from emulator.kernels.switching import likeliest_path, smoothed

    rng = np.random.default_rng(3)
    log_emission = rng.normal(size=(6, 3))
    start, move = np.array([0.5, 0.3, 0.2]), rng.dirichlet(np.ones(3), 3)
    share, pairs, path = np.empty((6, 3)), np.zeros((3, 3)), np.empty(6, dtype=np.int64)
    log_p = smoothed(log_emission, start, move, share, pairs)
    likeliest_path(log_emission, np.log(start), np.log(move), path)
    naive_share, naive_log_p, naive_path = naive_chain(log_emission, start, move)
    assert np.allclose(share, naive_share) and log_p == pytest.approx(naive_log_p)
    assert np.array_equal(path, naive_path)
    assert pairs.sum() == pytest.approx(5) and np.allclose(pairs.sum(axis=1), share[:-1].sum(axis=0))


def test_a_chain_finds_its_own_parameters():
    rng = np.random.default_rng(5)
    state = np.repeat(np.arange(60) % 2, rng.integers(10, 30, 60))
    x = np.where(state[:, None], [1.0, 0.0], [-1.0, 0.5]) + rng.normal(0, 0.6, (len(state), 2))
    chain = Chain.fit([x], [(x[:, 0] > 0.3).astype(int)], 10.0)
    assert np.allclose(chain.mean, [[-1.0, 0.5], [1.0, 0.0]], atol=0.1)
    assert np.allclose(chain.covariance, 0.36 * np.eye(2), atol=0.08)
    assert np.mean(chain.path(x) == state) > 0.98


def test_a_guess_without_two_states_is_refused():
    with pytest.raises(ValueError, match="first guess"):
        Chain.fit([np.zeros((5, 1))], [np.zeros(5, dtype=int)], 3.0)
