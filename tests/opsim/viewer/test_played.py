import numpy as np
import pytest

from opsim.libraries import load_library
from opsim.shipped import shipped_folder
from opsim.viewer.playback import Collected, is_of_coefficients, travels_m


def drawn(library, task, **condition):
    model = load_library(shipped_folder() / "libraries" / library)[task]
    return model.sample(5, np.random.default_rng(0), condition=condition or None)


def test_whose_paths_are_quickly_made_is_told_by_the_model():
    assert is_of_coefficients(drawn("bench_work.npz", "stoop"))
    assert not is_of_coefficients(drawn("walking.npz", "walk", distance_m=3.0))


def test_each_performance_that_leads_somewhere_has_its_own_end():
    some, found = drawn("bench_work.npz", "carry"), Collected()
    found.add("carry", "carry", some[:2])
    found.add("carry", "carry", some[2:])
    path = some.path(n_times=2)
    assert travels_m(found.close()) == pytest.approx(path[:, 1, :2] - path[:, 0, :2])
    assert np.ptp(path[:, 1, 0]) > 0.01
