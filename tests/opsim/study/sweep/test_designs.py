import sys
import warnings

import numpy as np
import pytest

from opsim.study.sweep.designs import (
    Missing,
    grid,
    latin_hypercube,
    morris,
    one_at_a_time,
    power_of_two,
    saltelli,
    sobol,
)


def test_a_grid_is_every_combination_once():
    rows = grid([2, 3]).tolist()
    assert rows == [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]]


def test_one_at_a_time_is_the_base_and_each_level_alone():
    assert one_at_a_time([2, 1]).tolist() == [[-1, -1], [0, -1], [1, -1], [-1, 0]]


def test_a_latin_hypercube_has_one_point_in_every_slice_of_every_factor(rng):
    shares = latin_hypercube(20, 3, rng)
    assert np.array_equal(np.sort((shares * 20).astype(int), axis=0), np.tile(np.arange(20)[:, None], 3))


def test_points_are_those_of_scipy_with_the_same_generator():
    from scipy.stats import qmc

    hypercube = qmc.LatinHypercube(3, rng=np.random.default_rng(5)).random(8)
    sequence = qmc.Sobol(3, scramble=True, rng=np.random.default_rng(5)).random(8)
    assert np.array_equal(latin_hypercube(8, 3, np.random.default_rng(5)), hypercube)
    assert np.array_equal(sobol(8, 3, np.random.default_rng(5)), sequence)


def test_a_sobol_sequence_of_any_length_comes_without_a_warning(rng):
    with warnings.catch_warnings():  # a mark would also fail where what other tests left is collected meanwhile
        warnings.simplefilter("error")
        assert sobol(6, 2, rng).shape == (6, 2)
    assert [power_of_two(n) for n in (1, 2, 3, 64, 65)] == [1, 2, 4, 64, 128]


def test_designs_of_sensitivity_move_one_factor_at_a_time(rng):
    rows = saltelli(4, 2, rng).reshape(4, 4, 2)
    assert np.array_equal(rows[:, 1, 1], rows[:, 0, 1]) and np.array_equal(rows[:, 2, 0], rows[:, 0, 0])
    paths = morris(3, 2, rng).reshape(3, 3, 2)
    assert (np.count_nonzero(np.diff(paths, axis=1), axis=2) == 1).all()


def test_where_salib_is_missing_it_is_said_what_to_install(rng, monkeypatch):
    monkeypatch.setitem(sys.modules, "SALib.sample.sobol", None)
    with pytest.raises(Missing, match=r"pip install 'opsim\[sensitivity\]'"):
        saltelli(4, 2, rng)
