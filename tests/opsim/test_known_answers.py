"""The files of ``tests/known_answers`` against theory, at a part of what ``make known-answers`` simulates."""

import pytest
from known_answers import emulated_staffing, staffing
from known_answers.cases import CASES
from known_answers.chains import line_rate
from known_answers.simulate import simulate

from opsim.study.interval import t_interval

LONG = {
    *(("gershwin", variant) for variant in ("n10", "n20", "uneven", "infinite")),
    *(("base_stock", "base"), ("priorities", "restart"), ("priorities", "shortest"), ("batches", "eight")),
    *(("kitting", "uneven"), ("interrupted", "in_use_spread"), ("transfer_line", "k10")),
    *(("polling", "limited"), ("mmc", "two_servers"), ("mmc", "eight_servers"), ("priorities", "resume")),
    ("interrupted", "any_time"),
}
"""Need more replications than there is time for here: ``make known-answers`` alone simulates them."""
HERE = [case for case in CASES if (case.file, case.variant) not in LONG]


@pytest.fixture(scope="module")
def runs():
    HERE[0].answer()
    return simulate(HERE, few=True, processes=2)


@pytest.mark.parametrize(("mean_s", "phases", "rate"), [
    ((1.0, 1.0), 1, 2 / 3),  # Hunt 1956
    ((1.0, 1.0, 1.0), 1, 22 / 39),  # Hillier & Boling 1967
    ((1.0, 1.0), 2, 8 / 11),  # 1 / E max(X1, X2)
])  # fmt: skip
def test_the_chain_gives_the_rates_of_the_books(mean_s, phases, rate):
    assert line_rate(mean_s, phases) == pytest.approx(rate, rel=1e-12)


def test_a_faster_station_in_the_middle_beats_a_balanced_line():
    arch, balanced, bowl = (line_rate((1.5 - middle / 2, middle, 1.5 - middle / 2)) for middle in (1.2, 1.0, 0.8))
    assert arch < balanced < bowl


@pytest.mark.slow
@pytest.mark.xdist_group("known answers")
@pytest.mark.parametrize("case", HERE, ids=lambda case: case.name)
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


@pytest.mark.slow
@pytest.mark.xdist_group("staffing")
def test_it_costs_the_same_where_the_work_is_emulated(tmp_path):
    """100 people leave 4 % of doubt about the fitted CV and 10 % about its share: the rate moves by 1.5 % or so."""
    cases, mean_s = emulated_staffing.written(tmp_path, 100, 4)
    runs = simulate(cases, few=True)
    for case in cases:
        rates, (mean, _) = emulated_staffing.rates(runs, case, mean_s[case.variant]), staffing.EXPECTED[case.variant]
        error = (rates.var(ddof=1) / len(rates) + staffing.ORACLE_ERROR**2 + (0.0075 * mean) ** 2) ** 0.5
        assert abs(rates.mean() - mean) <= 3 * error
