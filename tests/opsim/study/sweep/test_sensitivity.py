"""Ishigami's function, whose indices are known, through the code of a sweep."""

import numpy as np
import pytest

from opsim.scenario.schema.sweep import Sweep
from opsim.study.intervals import t_interval
from opsim.study.sweep.designs import morris, morris_effects, saltelli, sobol_indices
from opsim.study.sweep.factors import points_of
from opsim.study.sweep.study import _sensitivity

ALONE, TOTAL = (0.3139, 0.4424, 0.0), (0.5576, 0.4424, 0.2437)
"""Analytic, with a = 7 and b = 0.1. Source: Saltelli et al. 2008, Global Sensitivity Analysis, section 4.6."""


def ishigami(shares):
    x = np.pi * (2 * shares - 1)
    return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def test_the_indices_of_ishigami_are_the_analytic_ones(rng):
    found = sobol_indices(ishigami(saltelli(4096, 3, rng)), 3)
    assert [one.alone for one in found] == pytest.approx(ALONE, abs=0.02)
    assert [one.total for one in found] == pytest.approx(TOTAL, abs=0.02)
    assert all(abs(one.alone - known) < 1.5 * one.alone_half for one, known in zip(found, ALONE))


def test_the_same_seed_gives_the_same_intervals(rng):
    values = ishigami(saltelli(64, 3, rng))
    assert sobol_indices(values, 3, seed=0) == sobol_indices(values, 3, seed=0)
    assert sobol_indices(values, 3, seed=0) != sobol_indices(values, 3, seed=1)


def test_where_nothing_varies_no_factor_matters():
    assert all(one.total == 0 for one in sobol_indices(np.ones(20), 3))


def test_effects_of_a_straight_line_are_its_slopes_and_do_not_spread(rng):
    design = morris(6, 3, rng)
    found = morris_effects(design, design @ [3.0, -2.0, 0.0], 3)
    assert [one.alone for one in found] == pytest.approx([3, -2, 0])
    assert [one.total for one in found] == pytest.approx([3, 2, 0])
    assert max(one.spread for one in found) < 1e-12


@pytest.mark.parametrize("values", [2, 3, 4, 5, 6, 9])
def test_a_step_of_a_list_or_of_whole_numbers_moves_it_evenly_and_tells_its_whole_range(values, rng):
    vary = {"stations.a.buffer": list(range(values)), "stations.b.buffer": {"from": 1, "to": values}}
    points = points_of(Sweep.model_validate({"vary": vary, "design": "morris", "points": 6}), 3)
    figure = points.numbers() @ [1.0, -1.0] / (values - 1)
    means = [t_interval([one]) for one in figure]
    found = _sensitivity(points, means, 3)
    assert [one.alone for one in found] == pytest.approx([1, -1]) and max(one.spread for one in found) < 1e-9


def test_values_without_order_tell_the_change_from_one_to_another():
    vary = {"run.variability": ["full", "times only", "none"], "stations.b.buffer": [1, 2]}
    points = points_of(Sweep.model_validate({"vary": vary, "design": "morris", "points": 6}), 3)
    means = [t_interval([one]) for one in points.numbers()[:, 0]]
    assert [one.total for one in _sensitivity(points, means, 3)] == pytest.approx([1, 0])
