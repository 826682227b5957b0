import numpy as np
import pytest

from opsim.layout import distances_m


def test_known_distances():
    points = [(0.0, 0.0), (3.0, 4.0)]
    assert distances_m(points, "euclidean")[0][1] == 5.0
    assert distances_m(points, "rectilinear")[0][1] == 7.0


@pytest.mark.parametrize("distance", ["euclidean", "rectilinear"])
def test_distances_are_a_metric(distance):
    points = [tuple(p) for p in np.random.default_rng(0).normal(size=(8, 2))]
    d = np.array(distances_m(points, distance))
    assert np.all(np.diag(d) == 0) and np.array_equal(d, d.T)
    assert np.all(d[:, :, None] <= d[:, None, :] + d.T[None, :, :] + 1e-12)
