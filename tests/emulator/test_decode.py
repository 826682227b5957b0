import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from threadpoolctl import threadpool_limits

from emulator.geometry import sphere
from emulator.geometry.flattening import SIEM, Extrinsic
from emulator.kernels.sphere import PITCH
from emulator.model import decoding as decode
from emulator.model.reduction import JointPCA
from tests.made import random_warp

RNG = np.random.default_rng(5)


def posture_model(n_times=40, n_bones=7, size=0.02, offset=0.4, n_components=6):
    """A smooth made posture model: components are waves of ``size`` radians about a mean ``offset`` away."""
    clock = np.linspace(0, np.pi, n_times)
    waves = np.stack([np.sin((k + 1) * clock) for k in range(n_components)])
    basis = size * waves[:, :, None] * RNG.normal(size=(n_components, 1, 2 * n_bones))
    mean = offset * np.cos(clock)[:, None] * RNG.normal(size=2 * n_bones)
    flatten = SIEM(sphere.normalise(RNG.normal(size=(n_bones, 3))))
    return JointPCA(mean.ravel(), basis.reshape(n_components, -1), 1.0), flatten


def vector_model(n_times=40, n_bones=7, size=0.2, n_components=6):
    """The same of the vectors themselves: waves about directions that turn by half a circle."""
    clock = np.linspace(0, np.pi, n_times)
    waves = np.stack([np.sin((k + 1) * clock) for k in range(n_components)])
    basis = size * waves[:, :, None] * RNG.normal(size=(n_components, 1, 3 * n_bones))
    start, across = RNG.normal(size=(2, n_bones, 3))
    mean = np.cos(clock)[:, None, None] * start + np.sin(clock)[:, None, None] * across
    return JointPCA(sphere.normalise(mean).ravel(), basis.reshape(n_components, -1), 1.0), Extrinsic(n_bones)


def directions(posture, flatten, *asked):
    return decode.Decoder(posture, flatten).directions(*asked)


def some_places(n, n_times=40, n_places=33):
    return RNG.uniform(0, n_times - 1, (n, n_places))


@pytest.mark.parametrize("made", [posture_model, vector_model])
@pytest.mark.parametrize("n_bones", [1, 3, 16, 20, 33])
def test_the_kernel_is_the_numpy_twin(n_bones, made):
    posture, flatten = made(n_bones=n_bones)
    coefficients, place = RNG.normal(size=(5, 6)), some_places(5)
    want = decode.directions_numpy(posture, flatten, coefficients, place)
    assert np.abs(directions(posture, flatten, coefficients, place) - want).max() < 1e-12
    single = directions(posture, flatten, coefficients, place, np.float32)
    assert single.dtype == np.float32 and np.abs(single - want).max() < 1e-5


@pytest.mark.parametrize("made", [posture_model, vector_model])
def test_the_clocks_points_are_the_recorded_postures_and_between_them_speed_and_acceleration_do_not_jump(made):
    posture, flatten = made(n_bones=2)
    coefficients = RNG.normal(size=(1, 6))
    exact = flatten.inverse(posture.inverse(coefficients).reshape(1, 40, -1))
    assert np.abs(directions(posture, flatten, coefficients, np.arange(40.0)[None]) - exact).max() < 1e-12
    step = 1e-3
    about = np.arange(1.0, 38.0)[:, None] + step * np.array([-2, -1, 0, 1, 2])
    here = directions(posture, flatten, coefficients, about.reshape(1, -1)).reshape(37, 5, 2, 3)
    bend = np.diff(here, n=2, axis=1) / step**2
    assert np.abs(bend[:, 0] - bend[:, 2]).max() < 0.02 * np.abs(bend).max()


def test_control_points_are_scipys_cubic_spline():
    values = RNG.normal(size=(3, 30, 4))
    place = RNG.uniform(0, 29, (3, 50))
    want = np.stack([CubicSpline(np.arange(30.0), v)(at) for v, at in zip(values, place)])
    assert np.abs(decode.along(decode.control_points(values), place) - want).max() < 1e-11


@pytest.mark.parametrize(("size", "offset"), [(3.0, 0.4), (0.05, 3.5), (0.9, 1.2)])
def test_bones_beyond_the_series_are_decoded_all_the_same(size, offset):
    posture, flatten = posture_model(size=size, offset=offset)
    coefficients, place = RNG.normal(size=(9, 6)), some_places(9)
    got = directions(posture, flatten, coefficients, place)
    assert np.abs(got - decode.directions_numpy(posture, flatten, coefficients, place)).max() < 1e-12


def test_at_the_limit_of_the_series_the_digits_hold():
    flatten = SIEM(sphere.normalise(RNG.normal(size=(1, 3))))
    far = decode.LARGEST_TURN_RAD - 1e-6
    mean = np.column_stack([np.linspace(far - 0.1, far, 12), np.zeros(12)])
    posture = JointPCA(mean.ravel(), np.zeros((0, 24)), 1.0)
    place = np.linspace(0, 11, 21)[None]
    got, want = (f(posture, flatten, np.zeros((1, 0)), place) for f in (directions, decode.directions_numpy))
    assert np.abs(got - want).max() < 2e-13


@pytest.mark.parametrize("block_bytes", [1, 40_000, 10**9])
def test_the_size_of_a_block_changes_nothing(monkeypatch, block_bytes):
    posture, flatten = posture_model()
    coefficients, place = RNG.normal(size=(20, 6)), some_places(20)
    want = directions(posture, flatten, coefficients, place)
    monkeypatch.setattr(decode, "BLOCK_BYTES", block_bytes)
    assert np.abs(directions(posture, flatten, coefficients, place) - want).max() < 1e-13


def test_a_skeleton_too_large_for_the_kernel_is_decoded_by_numpy():
    posture, flatten = posture_model(n_bones=PITCH + 1)
    coefficients, place = RNG.normal(size=(2, 6)), some_places(2)
    want = decode.directions_numpy(posture, flatten, coefficients, place)
    assert np.abs(directions(posture, flatten, coefficients, place) - want).max() < 1e-13


def test_no_performance_gives_no_directions():
    posture, flatten = posture_model()
    assert directions(posture, flatten, np.zeros((0, 6)), np.zeros((0, 4))).shape == (0, 4, 7, 3)


def test_places_invert_the_warp_and_hold_its_ends():
    warps = np.array([random_warp(RNG, 60) for _ in range(8)])
    own = np.concatenate([np.sort(RNG.uniform(-0.1, 1.1, (8, 30))), RNG.uniform(-0.1, 1.1, (8, 30))], axis=1)
    own = np.concatenate([own, warps[:, ::7], np.tile([0.0, 1.0], (8, 1))], axis=1)
    want = np.stack([np.interp(at, warp, np.arange(60.0)) for at, warp in zip(own, warps)])
    assert np.abs(decode.places(warps, own) - want).max() < 1e-11


def test_what_is_kept_for_all_does_not_depend_on_how_many_threads_there_were():
    found = set()
    for threads in (1, 2):
        with threadpool_limits(threads, user_api="blas"):
            found.add(decode._to_control.__wrapped__(101).tobytes())
    assert len(found) == 1
