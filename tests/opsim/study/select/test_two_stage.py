"""Rinott's and Dudewicz and Dalal's procedures: their numbers by hand, their promise."""

import numpy as np
import pytest
from made_systems import normal_systems, slippage

from opsim.study.select import dudewicz_dalal, dudewicz_dalal_h, rinott, rinott_h
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
