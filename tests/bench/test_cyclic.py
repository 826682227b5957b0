"""Cyclic motion: what a fit and what a drawn pose cost. The answer is asserted first. Run by ``make bench``."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from bench.cpu import best_s
from scipy.linalg import cholesky

from emulator.cyclic.contacts import single_support
from emulator.cyclic.gaussian_process import GaussianProcess, Projected, log_likelihood
from emulator.cyclic.latent import PoseLatent, poses_of
from emulator.cyclic.switching_dynamics import SwitchingDynamics, distance
from emulator.model.library import MotionLibrary
from emulator.recordings.npz import read_recording
from emulator.skeleton import Skeleton
from tests.recordings import recording

N_POSES, RATE_HZ = 100_000, 30.0
SHIPPED = Path(__file__).parents[2] / "scenarios" / "libraries" / "walking.npz"


@cache
def walks():
    """The normal walks of bandai2: latents of three components, the foot that bears, and their space."""
    takes = read_recording(recording("bandai2_walk")).takes
    takes = [take for take in takes if take.covariates["cov_style"] == "normal"]
    skeleton = Skeleton(takes[0].names, takes[0].parents)
    poses = [poses_of(take.positions_m, skeleton, take.rate_hz) for take in takes]
    latent = PoseLatent.fit(poses, components=3)
    return [latent.forward(one) for one in poses], [single_support(take.contact) for take in takes], latent


def test_two_states_of_500_frames_are_fitted_within_60_factorisations():
    z, state, _ = walks()
    fitted = SwitchingDynamics.fit(z, state).fitted
    assert [len(one.x) for one in fitted.processes] == [500, 500]
    matrix = np.cov(np.random.default_rng(0).normal(size=(500, 1500)))
    fit_s, one_s = best_s(lambda: SwitchingDynamics.fit(z, state), lambda: cholesky(matrix, lower=True), rounds=3)
    print(
        f"\n2 states of 500 frames: {fitted.n_factorisations:.0f} factorisations of 500, with kernels, gradients,"
        f" classifier and support the time of {fit_s / one_s:.0f}"
    )
    assert fitted.n_factorisations <= 60


@pytest.mark.parametrize("together", [1, 100])
def test_walking_is_drawn_and_decoded_1000_times_as_fast_as_it_is_walked(together):
    z, state, latent = walks()
    dynamics = SwitchingDynamics.fit(z, state)
    start = np.repeat(z[0][20:21], together, axis=0)

    def draw():
        path = dynamics.sample(start, N_POSES // together, np.random.default_rng(0))[0]
        return path, [latent.inverse(part) for part in path.reshape(-1, 1000, 3)]

    path, poses = draw()
    assert distance(path.reshape(-1, 3), np.concatenate(z)).max() <= dynamics.bound and len(poses) == 100
    times = N_POSES / RATE_HZ / best_s(draw, rounds=2)[0]
    print(f"\n{together} walks together, drawn and decoded to directions: {times:.0f} times real time")
    assert times > 1000


def test_the_shipped_walk_is_drawn_and_decoded_1000_times_as_fast_as_it_is_walked():
    """64 walks of 3 to 8 m: beats, latents, and all joints on planted feet at the rate of the recordings."""
    model = MotionLibrary.load(SHIPPED)["walk"]
    at = {"distance_m": np.random.default_rng(0).uniform(3, 8, 64)}

    def draw(rate_hz=model.rate_hz):
        block = model.sample(64, np.random.default_rng(1), condition=at)
        return block, [track.joints_m(np.arange(0, s, 1 / rate_hz)) for track, s in zip(block.tracks, block.duration_s)]

    block, joints = draw()
    ends = [track.joints_m(track.node_s[-1:])[0, 0, 0] for track in block.tracks]
    assert np.allclose(ends, at["distance_m"], atol=0.01)
    alone, some_s = block[7].tracks[0], np.arange(0, 2, 0.1)
    assert np.abs(alone.joints_m(some_s) - block.tracks[7].joints_m(some_s)).max() < 1e-10
    spent_s = best_s(draw, lambda: draw(60.0), lambda: model.sample(64, np.random.default_rng(1), condition=at).tracks)
    own, twice, tracks = (block.duration_s.sum() / one for one in spent_s)
    frames = np.mean([len(one) for one in joints])
    print(
        f"\nshipped walk, {frames:.0f} frames each, drawn and decoded: {own:.0f} times real"
        f" time at {model.rate_hz:.0f} Hz, {twice:.0f} at 60 Hz; latents and beats alone {tracks:.0f}"
    )
    assert own > 1000


def test_a_projected_step_is_cheaper_than_an_exact_one_and_as_good():
    z, state, _ = walks()
    exact = SwitchingDynamics.fit(z, state).fitted.processes[0]
    seen = Projected.of(exact)
    near = exact.x + 0.02 * np.random.default_rng(0).normal(size=exact.x.shape)
    (mean, variance), (seen_mean, seen_variance) = exact.predict(near, noise=True), seen.predict(near, noise=True)
    error = np.abs(seen_mean - mean) / np.sqrt(variance)
    assert error.max() < 0.1 and np.abs(np.sqrt(seen_variance / variance) - 1).max() < 0.02
    exact_s, seen_s = best_s(lambda: exact.predict(near), lambda: seen.predict(near))
    print(
        f"\n{len(seen.points)} of {len(exact.x)} points: {exact_s / seen_s:.1f} times as fast in numpy, at most",
        end=" ",
    )
    print(f"{error.max():.3f} spreads off")
    assert exact_s > 2 * seen_s


def test_the_gradient_costs_few_factorisations():
    rng = np.random.default_rng(0)
    x = rng.normal(size=(500, 3))
    process = GaussianProcess.fit(x, np.tanh(x) + 0.1 * rng.normal(size=(500, 3)))
    matrix = np.cov(rng.normal(size=(500, 1500)))
    one_s, factor_s = best_s(
        lambda: log_likelihood(process.hyper, x, process.y), lambda: cholesky(matrix, lower=True), rounds=20
    )
    print(f"\nlikelihood and gradient by 5 logarithms: the time of {one_s / factor_s:.1f} factorisations")
    assert one_s < 20 * factor_s
