"""Optimal computing budget allocation: the allocation of its formula, and what becomes of a budget."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made_systems import normal_systems, slippage
from scipy import stats

from opsim.study.select import ocba, ocba_allocation
from opsim.study.select.ocba import chance_of_best, shared

TEN = [f"s{i}" for i in range(10)]


def test_the_allocation_is_that_of_the_reference():
    found = ocba_allocation([1, 2, 3, 4], [1, 1, 2, 2], 100, better="less")
    expected = [31.802278499145903, 27.89906788671304, 27.89906788671304, 12.399585727428017]
    assert found == pytest.approx(expected, abs=1e-9)


def test_the_allocation_is_that_of_its_two_equations():
    means, sds = np.array([5.0, 4.0, 1.0]), np.array([2.0, 1.0, 3.0])
    n = ocba_allocation(means, sds, 300)
    assert n.sum() == pytest.approx(300) and n[1] / n[2] == pytest.approx((1 / 1) ** 2 / (3 / 4) ** 2)
    assert n[0] == pytest.approx(2.0 * np.sqrt((n[1] / 1.0) ** 2 + (n[2] / 3.0) ** 2))


def test_two_that_are_equal_do_not_take_the_whole_budget():
    found = ocba_allocation([1.0, 1.0, 0.0], [1.0, 1.0, 1.0], 90, least_gap=0.5)
    assert found[0] == pytest.approx(found[1], rel=0.05) and found[2] > 5


def test_the_chance_of_two_systems_is_that_of_students_t_with_welchs_freedom():
    """1.7613 standard errors apart with 14 degrees of freedom: 0.95. Of 8 and 4 replications with variances 4 and 1:
    (1/2 + 1/4)^2 / (1/4 / 7 + 1/16 / 3) = 9.947 degrees, of which 1.8134 is the quantile of 0.95."""
    found = chance_of_best(np.array([0.0, 1.7613101]), np.ones(2) * 2, np.array([8, 8]), better="more")
    assert found == pytest.approx(0.95, abs=1e-6)
    gap = stats.t.ppf(0.95, 0.75**2 / (0.25 / 7 + 0.0625 / 3)) * np.sqrt(0.75)
    found = chance_of_best(np.array([0.0, gap]), np.array([2.0, 1.0]), np.array([8, 4]), better="more")
    assert found == pytest.approx(0.95, abs=1e-9)


def test_without_any_spread_the_better_is_certain_and_equals_are_even():
    two = np.zeros(2), np.array([5, 5])
    assert chance_of_best(np.array([0.0, 1.0]), *two, better="more") == 1.0
    assert chance_of_best(np.array([1.0, 1.0]), *two, better="more") == 0.5


@pytest.mark.slow
def test_the_probability_is_not_more_than_how_often_it_is_right_from_few_replications():
    """Means drawn at random, five replications first: 600 times, right as often as said within two standard errors."""
    said = right = 0.0
    for m in range(600):
        means = np.random.default_rng([41, m]).normal(size=5)
        found = ocba(normal_systems(means, np.ones(5), 42, m, n=500), TEN[:5], indifference=0.3, first_stage=5,
                     batch=5, budget=400)  # fmt: skip
        said += found.posterior[1]
        right += means[TEN.index(found.winner)] >= means.max() - 0.3
    assert said <= right + 2 * np.sqrt(600 * 0.05 * 0.95)


@given(st.lists(st.floats(-50, 50), min_size=1, max_size=8), st.integers(1, 40))
def test_what_is_shared_out_is_whole_and_all_of_it(wanted, amount):
    found = shared(np.array(wanted), amount)
    assert sum(found) == amount and min(found) >= 0
    assert any(one > 0 for one in wanted) <= all(n == 0 for n, one in zip(found, wanted) if one <= 0)


def test_the_budget_is_spent_and_no_more():
    found = ocba(normal_systems(slippage(), np.full(10, 9.0), 3), TEN, indifference=0.01, budget=333, batch=50)
    assert (sum(found.n), found.ended) == (333, "spent")


def test_it_ends_before_the_budget_where_the_answer_is_clear():
    found = ocba(normal_systems([0.0, 9.0, 0.0], np.ones(3), 4), TEN[:3], indifference=0.5, budget=5000)
    assert (found.winner, found.ended, sum(found.n)) == ("s1", "chosen", 30)
    assert found.posterior is not None and 0.95 <= found.posterior[0] <= found.posterior[1] <= 1


def test_a_budget_below_the_first_stage_is_refused():
    with pytest.raises(ValueError, match=r"first stage alone needs 100 \(10 of each of 10\) replications, found 50"):
        ocba(normal_systems(slippage(), np.ones(10)), TEN, indifference=1.0, budget=50)


@pytest.mark.slow
def test_the_best_is_found_more_often_than_with_the_same_number_for_each():
    """At 300 replications of ten systems, 200 times; equal shares are right where the best has the largest mean."""
    right = even = 0
    for m in range(200):
        observe = normal_systems(np.linspace(0, 2, 10), np.full(10, 3.0), 31, m, n=400)
        right += ocba(observe, TEN, indifference=1e-6, budget=300, confidence=0.999999).winner == "s9"
        even += int(np.argmax([observe([(i, 0, 30)])[0].mean() for i in range(10)])) == 9
    assert right > even + 10
