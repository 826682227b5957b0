"""Hiring luck of a known line; ``python -m study_evidence.staffing`` does the same with 800 workforces."""

import pytest
from study_evidence.staffing import EXPECTED, split


@pytest.mark.slow
@pytest.mark.parametrize("variant", ["half"])
def test_hiring_luck_is_that_of_the_recursion_within_a_quarter_and_apart_from_run_noise(variant):
    parts = split(variant, workforces=80, replications=2, horizon="400 s")  # error of an SD of 80: 8 %
    assert parts["staffing"].sd == pytest.approx(EXPECTED[variant], rel=0.25)
    assert parts["staffing"].low_sd <= EXPECTED[variant] <= parts["staffing"].high_sd
    assert parts["run"].sd < 0.35 * parts["staffing"].sd


@pytest.mark.slow
def test_where_people_are_alike_there_is_no_hiring_luck():
    parts = split("none", workforces=4, replications=2, horizon="300 s")
    assert parts["staffing"].estimate == pytest.approx(0, abs=1e-12)
    assert parts["day"].sd > 0
