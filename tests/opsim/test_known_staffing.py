"""``tests/known_answers/staffing.yaml`` against the recursion of a line: what variance between people costs."""

import pytest
from known_answers import emulated_staffing, staffing
from known_answers.simulate import simulate


@pytest.mark.slow
def test_variance_between_people_costs_a_line_what_the_recursion_says():
    runs = simulate(staffing.CASES, few=True)
    for variant, (mean, sd) in staffing.EXPECTED.items():
        rates = staffing.rates(runs, variant)
        spread = rates.std(ddof=1)
        assert abs(rates.mean() - mean) <= 4 * (spread**2 / len(rates) + staffing.ORACLE_ERROR**2) ** 0.5
        assert sd is None or abs(spread - sd) <= 4 * sd / (2 * (len(rates) - 1)) ** 0.5


@pytest.mark.slow
def test_it_costs_the_same_where_the_work_is_emulated(tmp_path):
    """100 people leave 4 % of doubt about the fitted CV and 10 % about its share: the rate moves by 1.5 % or so."""
    cases, mean_s = emulated_staffing.written(tmp_path, 100, 4)
    runs = simulate(cases, few=True)
    for case in cases:
        rates, (mean, _) = emulated_staffing.rates(runs, case, mean_s[case.variant]), staffing.EXPECTED[case.variant]
        error = (rates.var(ddof=1) / len(rates) + staffing.ORACLE_ERROR**2 + (0.0075 * mean) ** 2) ** 0.5
        assert abs(rates.mean() - mean) <= 3 * error
