"""Switching dynamics: the compiled steps, what a fit costs, and what draws must keep of the recording."""

import numpy as np
import pytest

from emulator.cyclic.contacts import found_states
from emulator.cyclic.gaussian_process import GaussianProcess, Projected
from emulator.cyclic.latent import PoseLatent, poses_of
from emulator.cyclic.switching_dynamics import TRIES, Support, SwitchingDynamics, distance, held_out_distances
from emulator.skeleton import standard_skeleton
from tests.emulator.cyclic.formulas import X, Y
from tests.made.rowing import RATE_HZ, made_rowing
from tests.naive import naive_steps


def made_cycles(n_takes=4, n_frames=150, *, seed=0, noise=0.01):
    """A loop in three dimensions with a corner where the state changes, of 30 frames, never quite the same."""
    rng = np.random.default_rng(seed)
    takes, states = [], []
    for _ in range(n_takes):
        phase = rng.uniform() + np.cumsum(1 / 30 + rng.normal(0, 0.001, n_frames))
        turn = 2 * np.pi * phase
        bend = np.abs(np.sin(turn))
        takes.append(
            np.column_stack([np.cos(turn), 0.5 * np.sin(turn), 0.4 * bend]) + rng.normal(0, noise, (n_frames, 3))
        )
        states.append(np.where(np.sin(turn) > 0, 1, 2))
    return takes, states


@pytest.fixture(scope="module")
def cycles():
    return made_cycles()


@pytest.fixture(scope="module")
def dynamics(cycles):
    return SwitchingDynamics.fit(*cycles)


def drawn(dynamics, n=3, n_steps=50, seed=0, **more):
    return dynamics.sample(dynamics.starts[:n], n_steps, np.random.default_rng(seed), **more)


def test_paths_are_the_naive_ones(dynamics):
    z, state = drawn(dynamics, 2, 15)
    noise = np.random.default_rng(0).standard_normal((2, 14, TRIES, 3))
    naive_z, naive_state = naive_steps(dynamics.tables, np.empty((2, 15, 0)), noise, dynamics.starts[:2])
    assert np.allclose(z, naive_z, atol=1e-9)
    assert np.array_equal(state, dynamics.states[naive_state])


def test_paths_of_three_states_with_controls_are_the_naive_ones(cycles):
    takes, states = cycles
    three = [np.where(z[:, 0] > 0.5, 7, state) for z, state in zip(takes, states)]
    controls = [np.full((len(z), 1), 0.1 * i) for i, z in enumerate(takes)]
    dynamics = SwitchingDynamics.fit(takes, three, controls=controls, at_most=60)
    z, state = drawn(dynamics, 1, 25, controls=np.array([[0.15]]))
    noise = np.random.default_rng(0).standard_normal((1, 24, TRIES, 3))
    naive_z, naive_state = naive_steps(dynamics.tables, np.full((1, 25, 1), 0.15), noise, dynamics.starts[:1])
    assert np.allclose(z, naive_z, atol=1e-9) and set(state.ravel()) == {1, 2, 7}
    assert np.array_equal(state, dynamics.states[naive_state])


def test_the_same_seed_gives_the_same_bytes_and_another_does_not(dynamics):
    assert drawn(dynamics)[0].tobytes() == drawn(dynamics)[0].tobytes()
    assert drawn(dynamics)[0].tobytes() != drawn(dynamics, seed=1)[0].tobytes()


def test_one_by_one_and_together_are_the_same_paths(dynamics):
    """Rows are drawn one after the other, so the second alone needs the generator where the first left it."""
    rng = np.random.default_rng(0)
    alone = [dynamics.sample(dynamics.starts[i], 50, rng)[0][0] for i in range(3)]
    assert np.array_equal(drawn(dynamics)[0], alone)


def test_arrays_keep_the_dynamics_to_the_bit(dynamics):
    again = SwitchingDynamics.from_arrays(dynamics.arrays())
    assert drawn(dynamics)[0].tobytes() == drawn(again)[0].tobytes()
    assert again.bound == dynamics.bound and np.array_equal(again.starts, dynamics.starts)


def test_states_are_told_as_they_were_given(dynamics, cycles):
    takes, states = cycles
    assert np.mean(dynamics.state(np.concatenate(takes)) == np.concatenate(states)) > 0.96
    assert dynamics.state(takes[0].reshape(15, 10, 3)).shape == (15, 10)


def test_a_path_starts_where_it_is_told_and_is_as_long(dynamics):
    z, state = drawn(dynamics, 2, 7)
    assert np.array_equal(z[:, 0], dynamics.starts[:2]) and z.shape == (2, 7, 3) and state.shape == (2, 7)


def test_draws_keep_period_and_spread(dynamics, cycles):
    z, state = drawn(dynamics, 4, 3000)
    begins = np.flatnonzero((state[0, 1:] == 1) & (state[0, :-1] == 2))
    assert len(begins) == pytest.approx(100, rel=0.1)
    assert np.allclose(z.std(axis=(0, 1)), np.concatenate(cycles[0]).std(axis=0), rtol=0.1)


def test_20000_draws_stay_on_the_manifold_and_those_without_support_do_not(dynamics, cycles):
    away = np.concatenate(held_out_distances(cycles[0]))
    frames = np.concatenate(cycles[0])
    assert dynamics.bound == away.max()
    assert distance(drawn(dynamics, 2, 10_000)[0], frames).max() <= dynamics.bound
    noisy = SwitchingDynamics.fit(*made_cycles(noise=0.08), on_support=False, switching=False)
    assert distance(drawn(noisy, 2, 10_000)[0], frames).max() > 2 * dynamics.bound


def test_pauses_are_kept_with_states_found_and_lost_by_a_single_process():
    """Share of still frames in 3,000 drawn ones; the single process is the paper's, free to go anywhere."""
    takes, truth = made_rowing()
    poses = [poses_of(take, standard_skeleton(), RATE_HZ) for take in takes]
    latents = [latent.forward(one) for latent in [PoseLatent.fit(poses, components=3)] for one in poses]
    speed = np.concatenate([np.linalg.norm(np.diff(z, axis=0), axis=1) for z in latents])
    paused = np.concatenate([state[:-1] for state in truth]) == 0
    limit = np.sqrt(np.median(speed[paused]) * np.median(speed[~paused]))
    states = found_states(latents, 3, RATE_HZ)
    still = {}
    for switching in (True, False):
        dynamics = SwitchingDynamics.fit(latents, states, switching=switching, on_support=switching)
        z, _ = drawn(dynamics, 1, 3000)
        still[switching] = np.mean(np.linalg.norm(np.diff(z[0], axis=0), axis=1) < limit)
    assert still[True] == pytest.approx(np.mean(speed < limit), rel=0.1)
    assert abs(still[False] / np.mean(speed < limit) - 1) > 0.2


def test_two_states_of_500_frames_are_fitted_within_60_factorisations():
    takes, states = made_cycles(8, 200, noise=0.02)
    dynamics = SwitchingDynamics.fit(takes, states)
    assert {len(process.x) for process in dynamics.fitted.processes} == {500}
    assert dynamics.fitted.n_factorisations <= 60


def test_the_single_process_has_one_state(cycles):
    single = SwitchingDynamics.fit(*cycles, switching=False)
    assert single.states.tolist() == [0] and set(drawn(single)[1].ravel()) == {0}


def test_controls_are_obeyed():
    """The control is the step length: twice of it is twice as fast."""
    rng = np.random.default_rng(0)
    takes, controls = [], []
    for speed in (0.5, 0.8, 1.2, 1.5):
        turn = rng.uniform(0, 6) + 0.2 * speed * np.arange(120)
        takes.append(np.column_stack([np.cos(turn), np.sin(turn)]) + rng.normal(0, 0.005, (120, 2)))
        controls.append(np.full((120, 1), speed))
    dynamics = SwitchingDynamics.fit(takes, [np.zeros(120, int)] * 4, controls=controls)
    for speed in (0.6, 1.0, 1.4):
        z, _ = drawn(dynamics, 1, 400, controls=np.array([[speed]]))
        turned = np.unwrap(np.arctan2(z[0, :, 1], z[0, :, 0]))
        assert (turned[-1] - turned[0]) / 399 == pytest.approx(0.2 * speed, rel=0.1)


def test_the_projected_process_is_the_exact_one_to_a_twentieth_of_its_spread():
    exact = GaussianProcess.fit(X, Y)
    near = X + 0.05 * np.random.default_rng(0).normal(size=X.shape)
    mean, variance = exact.predict(near, noise=True)
    seen_mean, seen_variance = Projected.of(exact).predict(near, noise=True)
    assert np.abs((seen_mean - mean) / np.sqrt(variance)).max() < 0.05
    assert np.abs(np.sqrt(seen_variance / variance) - 1).max() < 0.02


def test_an_odd_frame_is_no_support(cycles):
    takes = [z.copy() for z in cycles[0]]
    takes[1][50] = (3.0, 3.0, 3.0)
    support = Support.of(takes)
    assert support.points.max() < 2 and support.bound > 2 > support.radius


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda takes, states: (takes, states[:-1]), "3 rows of states"),
        (lambda takes, states: (takes, [states[0][:-1], *states[1:]]), "sequence 0: 150 latents, 149 states"),
        (
            lambda takes, states: (takes, [np.where(np.arange(150) == 9, 5, one) for one in states]),
            "state 5 has 4 steps",
        ),
        (lambda takes, states: ([], []), "0 sequences"),
    ],
)
def test_bad_training_is_refused_in_words(cycles, spoil, words):
    with pytest.raises(ValueError, match=words):
        SwitchingDynamics.fit(*spoil(*cycles))


def test_bad_starts_and_controls_are_refused_in_words(dynamics):
    with pytest.raises(ValueError, match="z0 must be"):
        dynamics.sample(np.zeros((1, 2)), 5, np.random.default_rng(0))
    with pytest.raises(ValueError, match="0 controls"):
        dynamics.sample(dynamics.starts[:1], 5, np.random.default_rng(0), controls=np.ones((1, 1)))
