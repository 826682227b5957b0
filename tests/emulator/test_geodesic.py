import numpy as np
import pytest

from emulator.geometry import flattening as geodesic
from emulator.geometry import sphere
from tests.made import made_sequences

RNG = np.random.default_rng(2)


@pytest.mark.parametrize("n_times", [8, 60, 301])  # steps beyond the series, and within
def test_the_series_are_the_geodesics(n_times):
    sequence = made_sequences(1, n_times, n_bones=6, seed=4)[0][0]
    place = np.concatenate([RNG.uniform(0, n_times - 1, 80), [0.0, n_times - 1.0, 3.0]])
    assert np.abs(geodesic.along(sequence, place) - geodesic.along_numpy(sequence, place)).max() < 1e-12


def test_half_way_is_the_middle_of_the_arc():
    p, q = np.array([0, 0, 1.0]), np.array([np.sin(0.2), 0, np.cos(0.2)])
    middle = geodesic.along(np.stack([p, q])[:, None], np.array([0.5]))[0, 0]
    assert np.allclose(middle, [np.sin(0.1), 0, np.cos(0.1)], atol=1e-15)


def test_at_the_largest_step_the_digits_hold():
    p = sphere.normalise(RNG.normal(size=(1, 20, 3)))
    angle = geodesic.LARGEST_STEP_RAD - 1e-9
    q = sphere.exp(p, angle * sphere.basis(p)[..., 0, :])
    sequence, place = np.concatenate([p, q]), np.linspace(0, 1, 30)
    assert np.abs(geodesic.along(sequence, place) - geodesic.along_numpy(sequence, place)).max() < 1e-13


def test_opposite_neighbours_are_refused_only_where_they_are_used():
    p = np.array([[0, 0, 1.0]])
    sequence = np.stack([p, p, -p])
    assert np.allclose(geodesic.along(sequence, np.array([0.5])), p)
    with pytest.raises(ValueError, match="opposite"):
        geodesic.along(sequence, np.array([1.5]))
