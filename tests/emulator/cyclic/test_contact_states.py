"""States without labels: bearing feet from their speeds, phases of a cycle from a chain over the latent velocity."""

import numpy as np
import pytest

from emulator.cyclic.contacts import (
    Chain,
    contact_of,
    contact_of_state,
    contact_speed_m_per_s,
    found_states,
    single_support,
    state_of_contact,
    without_flicker,
)
from emulator.cyclic.latent import PoseLatent, poses_of
from emulator.recordings.npz import read_recording
from emulator.skeleton import standard_skeleton
from tests.made_rowing import RATE_HZ, made_rowing
from tests.naive import naive_chain
from tests.recordings import recording

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
