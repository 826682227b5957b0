"""Rinott's and Dudewicz and Dalal's procedures: their numbers by hand, their promise.

Optimal computing budget allocation: the allocation of its formula, and what becomes of a budget.

The constants of two-stage procedures against quadratures done elsewhere and against each other.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made.systems import normal_systems, slippage
from scipy import stats

from opsim.study.select import dudewicz_dalal, dudewicz_dalal_h, ocba, ocba_allocation, rinott, rinott_h
from opsim.study.select.constants import check_confidence, kn_eta
from opsim.study.select.constants import dudewicz_dalal_h as dudewicz_dalal_h_of_constants
from opsim.study.select.constants import rinott_h as rinott_h_of_constants
from opsim.study.select.ocba import chance_of_best, shared
from opsim.study.select.two_stage import first_weight

TEN = [f"s{i}" for i in range(10)]


def test_rinott_asks_for_as_many_as_the_spread_of_the_first_stage_says():
    observe = normal_systems([0.0, 0.0, 1.0], [1.0, 2.0, 3.0], 1)
    found = rinott(observe, TEN[:3], indifference=0.5)
    sd = [of[:20, 0].std(ddof=1) for of in found.values]
    assert found.n == tuple(max(20, int(np.ceil((rinott_h(3, 0.95, 20) * s / 0.5) ** 2))) for s in sd)
    assert found.means == pytest.approx([of.mean() for of in found.values])


def test_the_weights_are_those_of_the_book():
    """Law, section 10.2.1: W1 = n0 / N (1 + sqrt(1 - N / n0 (1 - (N - n0) d^2 / (h1^2 S^2)))), N the smallest that is
    enough, so that sum of squared weights / replications is d^2 / (h1^2 S^2)."""
    ratio = 5.3  # h1 S / d
    n = max(21, int(np.ceil(ratio**2)))
    first = first_weight(20, n, ratio)
    assert first**2 / 20 + (1 - first) ** 2 / (n - 20) == pytest.approx(1 / ratio**2, rel=1e-12)


def test_systems_without_spread_need_no_second_stage_and_have_their_mean():
    found = dudewicz_dalal(normal_systems([1.0, 2.0], [0.0, 0.0]), TEN[:2], indifference=0.1)
    assert (found.winner, found.n, found.means) == ("s1", (21, 21), (1.0, 2.0))


def test_a_second_stage_that_is_too_long_is_not_begun():
    found = rinott(normal_systems([0.0, 1.0], [50.0, 1.0], 2), TEN[:2], indifference=0.5, most=500)
    assert (found.ended, found.winner, found.asked) == ("ran out", "", (20, 20))
    assert found.needed[0] > 500 >= found.needed[1]


def test_dudewicz_and_dalal_ask_for_less_than_rinott():
    assert dudewicz_dalal_h(10, 0.95, 20) < rinott_h(10, 0.95, 20)


@pytest.mark.slow
@pytest.mark.parametrize("procedure", [rinott, dudewicz_dalal])
def test_two_stages_keep_their_promise_where_it_is_hardest(procedure):
    winners = [
        procedure(normal_systems(slippage(), np.full(10, 2.0), 21, m, n=400), TEN, indifference=1.0).winner
        for m in range(300)
    ]
    assert winners.count("s3") >= 276


def test_the_first_weight_solves_the_equation_and_is_no_less_than_the_first_stages_share():
    """Dudewicz & Dalal 1975: w^2 / n_0 + (1 - w)^2 / (n - n_0) = (indifference / (h s))^2, the larger of its roots."""
    for n, ratio in ((20, 4.0), (35, 5.5), (12, 3.3)):
        weight = first_weight(10, n, ratio)
        assert weight**2 / 10 + (1 - weight) ** 2 / (n - 10) == pytest.approx(1 / ratio**2, rel=1e-12)
        assert weight >= 10 / n


OCBA_TEN = [f"s{i}" for i in range(10)]


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
        found = ocba(normal_systems(means, np.ones(5), 42, m, n=500), OCBA_TEN[:5], indifference=0.3, first_stage=5,
                     batch=5, budget=400)  # fmt: skip
        said += found.posterior[1]
        right += means[OCBA_TEN.index(found.winner)] >= means.max() - 0.3
    assert said <= right + 2 * np.sqrt(600 * 0.05 * 0.95)


@given(st.lists(st.floats(-50, 50), min_size=1, max_size=8), st.integers(1, 40))
def test_what_is_shared_out_is_whole_and_all_of_it(wanted, amount):
    found = shared(np.array(wanted), amount)
    assert sum(found) == amount and min(found) >= 0
    assert any(one > 0 for one in wanted) <= all(n == 0 for n, one in zip(found, wanted) if one <= 0)


def test_the_budget_is_spent_and_no_more():
    found = ocba(normal_systems(slippage(), np.full(10, 9.0), 3), OCBA_TEN, indifference=0.01, budget=333, batch=50)
    assert (sum(found.n), found.ended) == (333, "spent")


def test_it_ends_before_the_budget_where_the_answer_is_clear():
    found = ocba(normal_systems([0.0, 9.0, 0.0], np.ones(3), 4), OCBA_TEN[:3], indifference=0.5, budget=5000)
    assert (found.winner, found.ended, sum(found.n)) == ("s1", "chosen", 30)
    assert found.posterior is not None and 0.95 <= found.posterior[0] <= found.posterior[1] <= 1


def test_a_budget_below_the_first_stage_is_refused():
    with pytest.raises(ValueError, match=r"first stage alone needs 100 \(10 of each of 10\) replications, found 50"):
        ocba(normal_systems(slippage(), np.ones(10)), OCBA_TEN, indifference=1.0, budget=50)


@pytest.mark.slow
def test_the_best_is_found_more_often_than_with_the_same_number_for_each():
    """At 300 replications of ten systems, 200 times; equal shares are right where the best has the largest mean."""
    right = even = 0
    for m in range(200):
        observe = normal_systems(np.linspace(0, 2, 10), np.full(10, 3.0), 31, m, n=400)
        right += ocba(observe, OCBA_TEN, indifference=1e-6, budget=300, confidence=0.999999).winner == "s9"
        even += int(np.argmax([observe([(i, 0, 30)])[0].mean() for i in range(10)])) == 9
    assert right > even + 10


H1 = {
    (2, 0.90): 1.8957,
    (2, 0.95): 2.4525,
    (5, 0.90): 2.7471,
    (5, 0.95): 3.2580,
    (10, 0.90): 3.1820,
    (10, 0.95): 3.6788,
}
H = {(2, 0.95, 20): 2.4525, (10, 0.95, 20): 3.8753, (10, 0.90, 20): 3.4374, (5, 0.95, 10): 3.6926}


@pytest.mark.parametrize(("k", "confidence"), H1)
def test_dudewicz_and_dalals_constant_is_that_of_the_table(k, confidence):
    assert dudewicz_dalal_h_of_constants(k, confidence, 20) == pytest.approx(H1[k, confidence], abs=1e-4)


@pytest.mark.parametrize("asked", H)
def test_rinotts_constant_is_that_of_the_double_integral(asked):
    assert rinott_h_of_constants(*asked) == pytest.approx(H[asked], abs=1e-4)


@pytest.mark.parametrize("n0", [2, 3, 10, 60])
def test_both_constants_are_the_same_for_two_systems(n0):
    """Given both spreads, the difference of two Student's t is normal: Rinott's integral, the other way round."""
    h = dudewicz_dalal_h_of_constants(2, 0.95, n0)
    assert rinott_h_of_constants(2, 0.95, n0) == pytest.approx(h, rel=2e-3 if n0 == 2 else 1e-5)


def test_with_many_replications_the_constants_are_those_of_known_spreads():
    """Bechhofer 1954: for k = 2, sqrt(2) times the normal quantile."""
    assert rinott_h_of_constants(2, 0.95, 5000) == pytest.approx(np.sqrt(2) * 1.6449, rel=1e-3)


@pytest.mark.parametrize("function", [rinott_h_of_constants, dudewicz_dalal_h_of_constants])
def test_more_systems_and_more_confidence_need_a_larger_constant(function):
    assert function(3, 0.9, 15) < function(4, 0.9, 15) < function(4, 0.95, 15) < function(4, 0.95, 8)


def test_eta_is_the_root_of_its_equation():
    eta = kn_eta(9, 0.05 / 9)
    assert 0.5 * (1 + 2 * eta) ** (-9 / 2) == pytest.approx(0.05 / 9, rel=1e-12)


@pytest.mark.parametrize("confidence", [0.25, 0.2, 1.0, 1.5, float("nan")])
def test_a_confidence_that_a_guess_has_too_is_refused(confidence):
    with pytest.raises(ValueError, match=r"between 0\.25 .* and 1, found"):
        check_confidence(confidence, 4)


REFERENCE = Path(__file__).parents[5] / "shared" / "data" / "reference" / "known_answers.json"


@pytest.mark.skipif(not REFERENCE.exists(), reason="shared data is not here")
def test_the_constants_are_those_of_the_reference():
    entries = {entry["name"]: entry["expected"] for entry in json.loads(REFERENCE.read_text())}
    for said, h in entries["Dudewicz-Dalal constant h1"].items():
        k, p = (float(part.split("=")[1]) for part in said.split(","))
        assert dudewicz_dalal_h_of_constants(int(k), p, 20) == pytest.approx(h, abs=1e-5)
    for said, h in entries["Rinott constant h"].items():
        k, p, n0 = (float(part.split("=")[1]) for part in said.split(","))
        assert rinott_h_of_constants(int(k), p, int(n0)) == pytest.approx(h, abs=1e-5)
