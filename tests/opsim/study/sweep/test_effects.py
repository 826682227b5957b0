"""Ishigami's function, whose indices are known, through the code of a sweep."""

import numpy as np
import pytest

from opsim.scenario.schema.sweep import Sweep
from opsim.study.intervals import t_interval
from opsim.study.sweep import grid, main_effects, tornado
from opsim.study.sweep.designs import morris, morris_effects, saltelli, sobol_indices
from opsim.study.sweep.effects import swing
from opsim.study.sweep.factors import points_of
from opsim.study.sweep.study import _sensitivity


def test_a_tornado_has_the_largest_swing_on_top_and_pairs_its_replications(rng):
    luck = rng.normal(0, 100, 8)
    small, large = rng.normal(0, 0.1, 8), rng.normal(0, 0.1, 8)
    found = tornado(
        luck, {"little": {"lo": luck - 1, "hi": luck + small}, "much": {"lo": luck - 5, "hi": luck + 5 + large}}
    )
    assert [one.name for one in found] == ["much", "little"]
    much = found[0]
    assert [much.levels[k].name for k in (much.least, much.most)] == ["lo", "hi"] and much.clear
    assert much.rise.mean == pytest.approx(10 + large.mean()) and much.rise.half_width < 0.2


def test_the_base_counts_as_a_level_so_that_a_best_in_the_middle_is_seen(rng):
    luck = rng.normal(0, 1, 8)
    one = tornado(luck, {"speed": {"lo": luck - 5, "hi": luck - 4 - rng.normal(0, 0.1, 8)}}, {"speed": "60 s"})[0]
    assert one.levels[one.most].name == "60 s"


def test_the_interval_of_the_two_levels_furthest_apart_counts_that_they_were_picked(rng):
    rows = {str(k): rng.normal(0, 1, 10) for k in range(3)}
    one = swing("nothing", rows, rows["0"])
    pair = rows[one.levels[one.most].name] - rows[one.levels[one.least].name]
    alone = t_interval(pair, 1 - 0.05 / 3)
    assert one.rise.half_width == pytest.approx(alone.half_width)


@pytest.mark.slow
def test_a_factor_that_does_nothing_is_called_clear_in_at_most_one_of_twenty_sweeps():
    rng = np.random.default_rng(6)
    clear = [swing("x", dict(zip("abcd", rng.normal(0, 1, (4, 6)))), np.zeros(6)).clear for _ in range(1000)]
    assert np.mean(clear) < 0.05 + 3 * np.sqrt(0.05 * 0.95 / 1000)


def test_main_effects_are_means_over_all_combinations_of_the_others():
    design = grid([2, 3])
    values = (10 * design[:, 0] + design[:, 1])[:, None] + np.zeros((1, 4))
    a, b = main_effects(design, values, ["a", "b"], [["0", "1"], ["0", "1", "2"]])
    assert (a.name, a.rise.mean, b.rise.mean) == ("a", 10, 2)
    assert [level.mean.mean for level in b.levels] == [5, 6, 7] and b.levels[1].change.mean == 0


def test_what_is_the_same_everywhere_is_no_effect():
    one = swing("x", {"a": [1.0, 2.0], "b": [1.0, 2.0]}, [1.0, 2.0])
    assert one.nothing and not one.clear


def test_one_of_ten_factors_that_do_nothing_is_called_clear_in_at_most_one_of_twenty_sweeps():
    rng, sweeps = np.random.default_rng(7), 150
    factors = [f"x{k}" for k in range(10)]
    clear = [
        any(one.clear for one in tornado(rng.normal(0, 1, 6), {name: {"end": rng.normal(0, 1, 6)} for name in factors}))
        for _ in range(sweeps)
    ]
    assert np.mean(clear) < 0.05 + 3 * np.sqrt(0.05 * 0.95 / sweeps)


def test_a_factor_of_one_value_is_no_effect_but_left_out():
    values = np.random.default_rng(0).normal(0, 1, (3, 4))
    found = main_effects(grid([1, 3]), values, ["a", "b"], [["1"], ["1", "2", "3"]])
    assert [one.name for one in found] == ["b"]


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
