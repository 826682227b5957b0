import sys
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from opsim.scenario.schema.sweep import NotARange, Sweep, between, check_range, number_of, steps
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
from opsim.study.sweep.factors import MOST_POINTS, UNCHANGED, Factor, factors_of_points, points_of


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


VARY = {"release.every": {"from": "40 s", "to": "60 s"}, "stations.saw.buffer": [1, 2, 4]}


def points(**said):
    return points_of(Sweep.model_validate({"vary": VARY, **said}), 7)


def test_a_grid_takes_every_combination_of_levels_and_values():
    found = points(design="grid", levels=2)
    assert found.values == (("40 s", 1), ("40 s", 2), ("40 s", 4), ("60 s", 1), ("60 s", 2), ("60 s", 4))
    assert found.points(None)[3].changes == {"release.every": "60 s", "stations.saw.buffer": 1}


def test_the_design_follows_from_what_is_varied():
    assert points(levels=2).design == "grid" and points().design == "latin_hypercube"
    assert points(vary=None, points=[{"release.every": "9 s"}]).design == "list"


def test_ten_points_a_factor_are_taken_where_nobody_says_how_many():
    assert len(points().values) == 20 and len(points(design="sobol").values) == 32


def test_the_same_seed_gives_the_same_points():
    block = Sweep.model_validate({"vary": VARY, "points": 9})
    assert points_of(block, 7).values == points_of(block, 7).values != points_of(block, 8).values


def test_one_at_a_time_leaves_the_other_factors_alone():
    found = points(design="one_at_a_time")
    changes = [dict(point.changes) for point in found.points(None)]
    assert changes[:3] == [{}, {"release.every": "40 s"}, {"release.every": "60 s"}] and len(changes) == 6


def test_a_value_that_the_scenario_has_already_is_the_base_and_runs_once():
    found = replace(points(design="one_at_a_time"), bases={"release.every": "60 s", "stations.saw.buffer": "1"})
    assert [dict(point.changes) for point in dict.fromkeys(found.points(None))] == [
        {},
        {"release.every": "40 s"},
        {"stations.saw.buffer": 2},
        {"stations.saw.buffer": 4},
    ]


def test_numbers_that_are_no_power_of_two_are_said():
    assert "64 are" in points(design="sobol", points=50).words[0] and not points(design="sobol", points=64).words


def test_points_that_a_design_does_not_use_are_said():
    assert points(design="one_at_a_time", points=50).warned == (
        "The points of the design one_at_a_time follow from its factors: 'points: 50' is not used.",
    )


def test_a_latin_hypercube_gives_each_value_of_a_list_the_same_part():
    found = points(points=30)
    counts = np.unique([row[1] for row in found.values], return_counts=True)[1]
    assert counts.tolist() == [10, 10, 10] and found.numbers()[:, 0].min() >= 40


def test_too_many_points_are_refused():
    with pytest.raises(ValueError, match=f"at most {MOST_POINTS:,} are run"):
        points(vary={f"a.b{i}": list(range(1, 11)) for i in range(6)})


SHARES = st.floats(0, 1, exclude_max=True)


@pytest.mark.parametrize(
    "low, high, share, found",
    [
        ("40 s", "65 s", 0.5, "52.5 s"),
        ("40 s", "60 s", 1, "60 s"),
        (1, 4, 0.0, 1),
        (1, 4, 0.999, 4),
        (0.8, 1.2, 0.25, 0.9),
        (["0 m", "1 m"], ["4 m", "1 m"], 0.5, ["2 m", "1 m"]),
        (["0 m", "3 m"], ["4 m", "1 m"], 0.25, ["1 m", "2.5 m"]),
    ],
)
def test_between_two_values_lies_a_value_with_their_unit(low, high, share, found):
    assert between(low, high, share) == found


@given(st.integers(-5, 5), st.integers(1, 9), SHARES)
def test_between_whole_numbers_lie_whole_numbers(low, wide, share):
    value = between(low, low + wide, share)
    assert isinstance(value, int) and low <= value <= low + wide


@given(st.floats(-1e6, 1e6), st.floats(1e-3, 1e6), SHARES, SHARES)
def test_a_larger_share_is_never_a_smaller_value(low, wide, a, b):
    values = [between(low, low + wide, share) for share in sorted((a, b))]
    assert values[0] <= values[1]


def test_steps_have_both_ends_and_whole_numbers_only_once():
    assert steps("40 s", "60 s", 3) == ["40 s", "50 s", "60 s"]
    assert steps(1, 3, 9) == [1, 2, 3]


@pytest.mark.parametrize(
    "low, high, said",
    [
        ("40 s", "1 min", "need the same unit, found 's' and 'min'"),
        ("40 s", 60, "need the same unit, found 's' and no unit"),
        ("60 s", "40 s", "the wrong way round"),
        ("40 s", "40 s", "are the same"),
        ("full", "none", "'full' cannot be the end of a range"),
        ("1 min 30 s", "2 min", "quantities with one unit such as '90 s'"),
        (["1 m"], ["1 m", "2 m"], "lists of 1 and 2"),
        (True, 4, "true cannot be the end"),
    ],
)
def test_what_is_no_range_is_said(low, high, said):
    with pytest.raises(NotARange, match=said):
        check_range(low, high)


@given(st.text(max_size=20))
def test_any_text_is_a_number_or_none(text):
    found = number_of(text)
    assert found is None or isinstance(found[0], float)


def test_quantities_of_one_kind_are_numbers_in_the_unit_of_the_first():
    factor = Factor("release.every", ("30 s", "1 min", "90 s"))
    assert factor.is_number and factor.unit == "s"
    assert [factor.number(value) for value in factor.values] == [30, 60, 90] and factor.span == (30, 90)


def test_what_has_no_order_is_numbered():
    factor = Factor("run.variability", ("full", "none"))
    assert factor.categories == 2 and factor.number("none") == 1
    assert Factor("a.b", ("40 s", "2 m")).categories == 2


def test_a_range_of_places_is_a_number_from_0_to_1():
    factor = Factor("layout.places.rack", (["0 m", "0 m"], ["4 m", "2 m"]), is_range=True)
    assert not factor.categories and factor.number(factor.at(0.25)) == pytest.approx(0.25)


def test_points_given_one_by_one_leave_alone_what_they_do_not_name():
    buffer, every = factors_of_points([{"a.buffer": 2}, {"a.buffer": 3, "release.every": "9 s"}])
    assert buffer.values == (2, 3) and every.values == (UNCHANGED, "9 s")
    assert every.categories == 2 and every.words(UNCHANGED) == "as it is"
