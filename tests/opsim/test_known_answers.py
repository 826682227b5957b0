"""The scenario files of ``tests/known_answers`` against theory, at a twentieth of what ``make known-answers`` simulates."""

import pytest
from known_answers.cases import CASES
from known_answers.simulate import simulate

from opsim.study.interval import t_interval

REPLICATIONS = 16


@pytest.fixture(scope="module")
def runs():
    CASES[0].answer()
    return simulate([case for case in CASES], REPLICATIONS, processes=2)


@pytest.mark.slow
@pytest.mark.xdist_group("known answers")
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_theory_is_within_four_standard_errors(case, runs):
    interval = t_interval(runs[case.file, case.variant][case.kpi])
    standard_error = interval.sd / interval.n**0.5
    assert interval.half_width <= 0.05 * interval.mean
    assert abs(interval.mean - case.answer()) <= 4 * standard_error + 1e-6 * case.answer()
