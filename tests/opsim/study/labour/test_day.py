"""How days come out: exact where values are independent, careful where they go together.

What a day is: scheduled hours, and how many of them a run has.
"""

import numpy as np
import pytest
from scipy.special import bdtr, ndtr, ndtri

from opsim.plan import compile_plan
from opsim.study.labour.daily_output import chance, clopper_pearson, counts_as, day_asked, hours_and_days, quantile
from tests.opsim.study.labour.made import LINE, loaded
from tests.opsim.study.labour.test_parts import made


def test_clopper_and_pearson_leave_half_of_the_rest_on_each_side():
    low, high = clopper_pearson(7, 20)
    assert 1 - bdtr(6, 20, low) == pytest.approx(0.025)
    assert bdtr(7, 20, high) == pytest.approx(0.025)
    assert clopper_pearson(0, 20)[0] == 0 and clopper_pearson(20, 20)[1] == 1


def test_values_of_one_workforce_that_are_all_alike_count_once():
    alike = np.repeat(np.random.default_rng(1).normal(size=(12, 1)), 5, axis=1)
    assert counts_as(alike, "nested") == pytest.approx(12)


def test_independent_values_count_each():
    values = np.random.default_rng(2).normal(size=(30, 4))
    assert 60 < counts_as(values, "crossed") <= 120


def test_days_that_are_alike_for_all_count_as_the_days():
    values = np.tile(np.arange(4.0), (30, 1)) + 1e-6 * np.random.default_rng(2).normal(size=(30, 4))
    assert counts_as(values, "crossed") == pytest.approx(4, rel=1e-3)


@pytest.mark.parametrize(("design", "staffing", "day", "at"), [
    ("crossed", 1.0, 0.3, 1.0), ("crossed", 0.4, 1.0, 0.0), ("nested", 1.0, 0.3, 1.5),
])  # fmt: skip
def test_a_chance_is_held_at_least_as_often_as_is_said(design, staffing, day, at):
    rng, n = np.random.default_rng(4), 300
    spread = (staffing**2 + day**2 + 0.3**2) ** 0.5
    hits = 0
    for _ in range(n):
        values = made(rng, (40, 4), staffing, day, 0.3, design)
        found = chance(values, values <= 60 + at * spread, design)
        hits += found.low <= ndtr(at) <= found.high
    assert hits / n > 0.95 - 3 * (0.95 * 0.05 / n) ** 0.5


def odd_days(rng, shape):
    """People differ, days hardly do, but one in twenty goes wrong: the values hardly show that people differ."""
    people, days = rng.standard_normal((shape[0], 1)), 0.2 * rng.standard_normal(shape)
    return people + days - 12 * (rng.random(shape) < 0.05)


@pytest.mark.parametrize("at", [0.0, 1.5])
def test_a_chance_is_held_where_odd_days_hide_what_people_have_in_common(at):
    """By the values alone it would be held 0.80 times."""
    rng, n = np.random.default_rng(12), 200
    held = 0.95 * ndtr(at / 1.04**0.5) + 0.05 * ndtr((at + 12) / 1.04**0.5)
    hits = 0
    for _ in range(n):
        values = odd_days(rng, (40, 5))
        found = chance(values, values <= at, "nested")
        hits += found.low <= held <= found.high
    assert hits / n > 0.95 - 3 * (0.95 * 0.05 / n) ** 0.5


def test_a_median_is_held_where_odd_days_hide_what_people_have_in_common():
    rng, n = np.random.default_rng(13), 200
    middle = 1.04**0.5 * ndtri((0.5 - 0.05) / 0.95)
    found = [quantile(odd_days(rng, (40, 5)), 0.5, "nested") for _ in range(n)]
    assert np.mean([one.low <= middle <= one.high for one in found]) > 0.95 - 3 * (0.95 * 0.05 / n) ** 0.5


def test_a_target_that_is_always_met_counts_as_its_values_do():
    values = made(np.random.default_rng(5), (30, 4), 1.0, 0.0, 1.0, "nested")
    always = chance(values, values > -99, "nested")
    assert always.high == 1 and always.low > 0.9 and 30 < always.counts_as < 120


def test_a_quantile_has_an_interval_or_says_that_there_are_too_few_runs():
    values = np.random.default_rng(6).normal(size=(40, 5))
    middle, tail = quantile(values, 0.5, "nested"), quantile(values[:6, :2], 0.05, "nested")
    assert middle.low < 0 < middle.high and middle.low < middle.estimate < middle.high
    assert tail.low == -np.inf


ALWAYS_OPEN = LINE.replace(", shift: early", "").replace(", absence: 0.1", "")


@pytest.mark.parametrize(("text", "hours", "days"), [
    (LINE, 0.4, 1),  # 24 min of a shift
    (LINE.replace("horizon: 24 min", "horizon: 24 h"), 8, 1),
    (LINE.replace("horizon: 24 min", "horizon: 3 d"), 8, 3),
    (LINE.replace("horizon: 24 min", "horizon: 2 d").replace("to: 14:00", "to: 02:00"), 20, 2),  # past midnight
    (ALWAYS_OPEN, 0.4, 1),
    (ALWAYS_OPEN.replace("horizon: 24 min", "horizon: 48 h"), 24, 2),
])  # fmt: skip
def test_a_day_has_its_scheduled_hours(tmp_path, text, hours, days):
    assert hours_and_days(compile_plan(loaded(tmp_path, text))) == (pytest.approx(hours), days)


def test_a_target_of_a_figure_is_in_its_own_unit(tmp_path):
    plan = compile_plan(loaded(tmp_path))
    asked = day_asked("time_in_system_s <= 300", plan)
    assert (asked.kpi, asked.hours, asked.a_day) == ("time_in_system_s", 1.0, False)
    assert day_asked(None, plan).a_day and day_asked("4 a day", plan).hours == pytest.approx(0.4)
