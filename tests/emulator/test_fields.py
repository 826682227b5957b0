import numpy as np
import pytest

from emulator.geometry.elastic import warped, warped_numpy
from tests.made import random_warp

RNG = np.random.default_rng(9)
FIELDS = RNG.normal(size=(4, 50, 7))
WARPS = np.array([random_warp(RNG, 51) for _ in range(4)])


def test_the_identity_changes_nothing():
    assert np.allclose(warped(FIELDS, np.tile(np.linspace(0, 1, 51), (4, 1))), FIELDS, atol=1e-13)


def test_a_warp_at_half_speed_keeps_the_norm():
    step = np.repeat(FIELDS[:1, :25], 2, axis=1)
    half = np.concatenate([np.linspace(0, 0.25, 26), np.linspace(0.25, 1, 26)[1:]])[None]
    norms = [np.sum(field**2) for field in (warped(step, half), step)]
    assert norms[0] <= norms[1] + 1e-12
    assert np.allclose(warped(step, half)[0, :25], np.sqrt(0.5) * step[0, np.arange(25) // 2], atol=1e-12)


@pytest.mark.parametrize("n_times", [51, 31, 90])
def test_the_compiled_fields_are_the_numpy_fields(n_times):
    warps = np.array([random_warp(RNG, n_times) for _ in range(4)])
    assert np.abs(warped(FIELDS, warps) - warped_numpy(FIELDS, warps)).max() < 1e-11


def test_warping_by_a_path_of_the_grid_keeps_the_inner_product():
    from emulator.geometry import elastic

    q1, q2 = FIELDS[0], FIELDS[1]
    gamma, inner = elastic.best_warp(q1, q2)
    assert np.sum(q1 * warped(q2[None], gamma[None])[0]) / 50 == pytest.approx(inner, rel=1e-12)
