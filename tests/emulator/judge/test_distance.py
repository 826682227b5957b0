import numpy as np
import pytest

from emulator.judge.sequence_distances import distances, distances_numpy
from tests.emulator.judge.made import sequences


def turned(angle_rad):
    """A sequence of two bones, one of which is turned by the angle against the other sequence's."""
    x = np.tile([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], (3, 1, 1))
    y = x.copy()
    y[:, 0] = [np.sin(angle_rad), 0.0, np.cos(angle_rad)]
    return np.stack([x, y])


@pytest.mark.parametrize("angle_rad", [0.0, 1e-5, 0.01, 0.5, np.pi / 2 - 1e-3, np.pi / 2, 2.0, 3.0])
def test_one_bone_turned_is_that_angle_away(angle_rad):
    assert np.isclose(distances(turned(angle_rad))[0, 1], angle_rad, rtol=1e-6, atol=3e-8)


def test_opposite_bones_are_half_a_turn_apart():
    assert np.isclose(distances(turned(np.pi))[0, 1], np.pi, atol=1e-3)


@pytest.mark.parametrize("spread", [0.001, 0.1, 1.0])
def test_the_kernel_is_its_twin(spread):
    x, y = sequences(9, 60, 20, spread), sequences(70, 60, 20, spread, seed=1)
    assert np.allclose(distances(x, y), distances_numpy(x, y), rtol=1e-6, atol=0)
    off = ~np.eye(70, dtype=bool)
    assert np.allclose(distances(y)[off], distances_numpy(y)[off], rtol=1e-6 if spread > 0.01 else 1e-5, atol=0)


def test_distances_are_a_metric():
    d = distances(sequences())
    assert np.array_equal(d, d.T) and np.all(np.diag(d) == 0)
    assert np.all(d[:, :, None] <= d[:, None, :] + d[None, :, :] + 1e-6)


def test_the_order_of_the_sequences_and_threads_change_nothing():
    x = sequences(130)
    order = np.random.default_rng(0).permutation(len(x))
    assert np.allclose(distances(x)[np.ix_(order, order)], distances(x[order]), atol=1e-6)
    assert np.array_equal(distances(x), distances(x, n_threads=2))


@pytest.mark.parametrize(
    ("broken", "words"),
    [(lambda x: x[0], "expected"), (lambda x: x[:, :, :2], "alike"), (lambda x: x * np.nan, "not finite")],
)
def test_what_is_no_set_of_sequences_is_refused(broken, words):
    with pytest.raises(ValueError, match=words):
        distances(sequences(), broken(sequences()))
