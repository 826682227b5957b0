from itertools import combinations

import numpy as np
import pytest

from emulator.judge import disco, energy_v, pooled
from tests.emulator.judge.made import parts, plain_distances


def test_a_case_by_hand():
    """{0, 1} against {3, 4}: e = 2 * 3 - 1/2 - 1/2; S = (4 / 8) e = 2.5, W = 1/2 + 1/2 with one half a sample."""
    points = np.array([[0.0], [1.0], [3.0], [4.0]])
    found = disco(plain_distances(points, points), 2, np.random.default_rng(0))
    assert found.energy == 5.0
    assert np.isclose(found.f, 2.5 / (1.0 / (4 - 2)))
    # two of the six divisions ({01|34} and its mirror) are as far apart
    assert abs(found.p - 1 / 3) < 0.05


def test_the_statistic_is_the_energy_distance_and_permutations_are_those_of_the_definition():
    x, y = np.random.default_rng(3).normal(size=(2, 4, 2)) + np.array([0.0, 0.6])[:, None, None]
    d = pooled(*parts(x, y))
    of_all = []
    for first in combinations(range(8), 4):
        rest = [i for i in range(8) if i not in first]
        of_all.append(energy_v(d[np.ix_(first, rest)], d[np.ix_(first, first)], d[np.ix_(rest, rest)]))
    found = disco(d, 4, np.random.default_rng(0), 20_000)
    assert np.isclose(found.energy, of_all[0])
    assert abs(found.p - np.mean(np.array(of_all) >= of_all[0] - 1e-12)) < 0.015


def test_f_and_energy_order_divisions_alike():
    d = pooled(*parts(*np.random.default_rng(4).normal(size=(2, 6, 2))))
    orders = [np.random.default_rng(i).permutation(12) for i in range(30)]
    found = [disco(d[np.ix_(o, o)], 6, np.random.default_rng(0), 1) for o in orders]
    assert np.array_equal(np.argsort([f.energy for f in found]), np.argsort([f.f for f in found]))


def test_p_is_uniform_where_both_samples_are_of_one_law():
    from scipy.stats import kstest

    rng = np.random.default_rng(5)
    p = [disco(pooled(*parts(*rng.normal(size=(2, 15, 3)))), 15, rng, 199).p for _ in range(500)]
    assert kstest(p, "uniform").pvalue > 0.01
    assert 0.03 < np.mean(np.array(p) <= 0.05) < 0.075


@pytest.mark.parametrize("other", ["shifted", "wider"])
def test_another_mean_or_spread_is_seen(other):
    rng = np.random.default_rng(6)
    change = {"shifted": lambda y: y + 0.8, "wider": lambda y: 3.0 * y}[other]
    p = [disco(pooled(*parts(x, change(y))), 30, rng, 199).p for x, y in rng.normal(size=(40, 2, 30, 3))]
    assert np.mean(np.array(p) < 0.05) > 0.9


def test_p_is_never_zero():
    far = pooled(*parts(np.zeros((20, 1)) + np.arange(20)[:, None] * 1e-3, np.full((20, 1), 9.0)))
    assert disco(far, 20, np.random.default_rng(0), 99).p == 0.01


def test_an_empty_sample_is_refused():
    with pytest.raises(ValueError, match="expected 1 to 4"):
        disco(np.zeros((5, 5)), 5, np.random.default_rng(0))
