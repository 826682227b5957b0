"""The files of ``tests/known_answers`` against theory, at a part of what ``make known-answers`` simulates."""

import pytest
from known_answers import staffing
from known_answers.cases import CASES
from known_answers.simulate import simulate

from opsim.study.interval import t_interval


@pytest.fixture(scope="module")
def runs():
    CASES[0].answer()
    return simulate(CASES, few=True, processes=2)


@pytest.mark.slow
@pytest.mark.xdist_group("known answers")
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_theory_is_within_four_standard_errors(case, runs):
    interval = t_interval(runs[case.file, case.variant][case.kpi])
    standard_error = interval.sd / interval.n**0.5
    assert interval.half_width <= 0.05 * interval.mean
    assert abs(interval.mean - case.answer()) <= 4 * standard_error + 1e-6 * case.answer()


@pytest.mark.slow
@pytest.mark.xdist_group("staffing")
def test_variance_between_people_costs_a_line_what_the_recursion_says():
    runs = simulate(staffing.CASES, few=True)
    for variant, (mean, sd) in staffing.EXPECTED.items():
        rates = staffing.rates(runs, variant)
        spread = rates.std(ddof=1)
        assert abs(rates.mean() - mean) <= 4 * (spread**2 / len(rates) + staffing.ORACLE_ERROR**2) ** 0.5
        assert sd is None or abs(spread - sd) <= 4 * sd / (2 * (len(rates) - 1)) ** 0.5
