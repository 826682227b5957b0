"""What comes out, how long it stays, how much is inside.

Due dates: by hand arithmetic.

The rhythm that demand asks for.

Targets as they are written.

Amounts and limits as people write them.
"""

from dataclasses import replace
from math import exp, isnan, sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from made.shops import HEAD
from plans import CELL, line, plan, queue

from opsim.engine.floor.run import run_plan
from opsim.kpi.catalogue import AskedFigure as Asked
from opsim.kpi.targets import LimitText, amount, bounds, check_indifference, percent, read_limit, read_target, unit_of
from opsim.kpi.throughput import _takt_s, due_dates, takt, time_in_system, work_in_progress
from opsim.log import CREATE, FINISH
from opsim.plan import compile_plan
from opsim.scenario.read import scenarios_in
from opsim.subjects.exposure.figures import gini
from tests.opsim.kpi.made_logs import found, made, row

TWO = """
opsim: 1
name: two products
run: {horizon: 2000 s, warm_up: 200 s, seed: 3}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {dist: exponential, mean: 8 s, automatic: true}}
stations: {a: {at: here, tasks: [t]}, b: {at: here, tasks: [t]}}
products: {long: {share: 0.6, route: [a, b]}, short: {share: 0.4, route: [b]}}
release: {kind: poisson, every: 14 s}
"""


def stay(job, start, end, product):
    return [row(CREATE, start, start, job=job, product=product), row(FINISH, end, end, job=job, product=product)]


def drained(text):
    """A run cut at the last moment at which nobody was inside, and its plan with a window as long."""
    p = plan(text)
    log = run_plan(p)
    came, went = (log["end_s"][log["kind"] == kind] for kind in (CREATE, FINISH))
    empty = [(went[n - 1] + came[n]) / 2 for n in range(1, len(came)) if n <= len(went) and went[n - 1] < came[n]]
    assert len(empty) > 5
    cut = log.where(log["end_s"] <= empty[-1])
    return replace(cut, horizon_s=empty[-1]), replace(p, horizon_s=empty[-1], warm_up_s=empty[0])


def test_lead_times_and_their_quantiles_are_those_of_the_hand():
    p = plan(TWO)
    rows = [r for n in range(11) for r in stay(n, 300 + n, 300 + n + 10 * (n + 1), 0)] + stay(11, 250, 260, 1)
    values = found(made(rows, p), p)
    assert [values["lead_time_quantile_s", "long", q] for q in ("p10", "median", "p90", "p95")] == [20, 60, 100, 105]
    assert values["lead_time_s", "long", ""] == 60
    assert values["lead_time_s", "short", ""] == values["lead_time_quantile_s", "short", "p95"] == 10
    assert values["time_in_system_s", "", ""] == pytest.approx(670 / 12)
    assert values["time_in_system_quantile_s", "", "median"] == 55


def test_jobs_inside_by_product_are_those_of_the_hand():
    p = plan(TWO)
    values = found(made(stay(0, 100, 1100, 0) + stay(1, 500, 680, 1) + stay(2, 1910, 1999, 0)[:1], p), p)
    assert values["work_in_progress", "long", ""] == (900 + 90) / 1800
    assert values["work_in_progress", "short", ""] == 180 / 1800
    assert values["work_in_progress", "", ""] == pytest.approx((990 + 180) / 1800)


def test_a_floor_of_one_product_says_its_jobs_inside_once():
    p = plan(line(2, 1, horizon="1100 s"))
    assert len(list(work_in_progress(run_plan(p), p))) == 1


def test_littles_law_is_exact_of_each_product_on_a_floor_empty_at_both_ends():
    log, p = drained(TWO)
    values = found(log, p)
    for product, stay_kpi in (("", "time_in_system_s"), ("long", "lead_time_s"), ("short", "lead_time_s")):
        arrivals_per_s = values["throughput_per_h", product, ""] / 3600
        inside = values["work_in_progress", product, ""]
        assert inside == pytest.approx(arrivals_per_s * values[stay_kpi, product, ""], rel=1e-9)
        assert inside > 0


def test_quantiles_rise_and_hold_the_median_of_the_sample():
    p = plan(TWO)
    log = run_plan(p)
    values = [f.value for f in time_in_system(log, p) if f.kpi == "time_in_system_quantile_s"]
    assert values == sorted(values) and len(values) == 4
    assert np.all(np.diff(values) > 0)


SHOP = """
tasks: {cut: {fixed: 10 s, automatic: true}}
stations: {saw: {at: hall, tasks: [cut]}}
products: {a: {route: [saw], due: 15 s}, b: {route: [saw]}}
"""


def told(folder, orders):
    (folder / "orders.csv").write_text("\n".join(orders.split()) + "\n")
    made = compile_plan(scenarios_in((HEAD + SHOP).encode(), folder / "shop.yaml")["base"])
    return {(figure.kpi, figure.subject): figure.value for figure in due_dates(run_plan(made), made)}


def test_a_job_that_is_done_on_its_due_date_is_not_late_by_a_tick():
    text = HEAD.replace("{kind: schedule, file: orders.csv}", "{kind: renewal, every: {fixed: 9 s}}") + SHOP
    made = plan(
        text.replace("fixed: 10 s", "fixed: 6.3 s").replace(
            ", due: 15 s}, b: {", ", due: 6.3 s, share: 0.5}, b: {share: 0.5, "
        )
    )
    assert [figure.value for figure in due_dates(run_plan(made), made) if figure.kpi == "late_share"] == [0, 0]


def test_late_jobs_and_how_late_they_are(tmp_path):
    """Finished at 10, 20 and 30 s, due at 15 s each."""
    figures = told(tmp_path, "time,product 0,a 0,a 0,a")
    assert figures["late_share", ""] == pytest.approx(2 / 3)
    assert figures["tardiness_s", "a"] == pytest.approx((5 + 15) / 3)
    assert ("late_share", "b") not in figures


def test_the_order_says_its_own_due_date(tmp_path):
    """b without one, a due 15 s after it came, b due at 12 s."""
    figures = told(tmp_path, "time,product,due 0,b, 0,a, 0,b,12")
    assert figures == {
        ("late_share", ""): 1.0,
        ("late_share", "a"): 1.0,
        ("late_share", "b"): 1.0,
        ("tardiness_s", ""): pytest.approx((5 + 18) / 2),
        ("tardiness_s", "a"): 5.0,
        ("tardiness_s", "b"): 18.0,
    }


def test_without_due_dates_nothing_is_said():
    made = plan(CELL)
    assert list(due_dates(run_plan(made), made)) == []


EVERY_10 = queue(horizon="100 s", warm_up="20 s", every="10 s")


def attained(finishes_s, p):
    rows = [row(kind, at, at, job=n) for n, at in enumerate(finishes_s) for kind in (CREATE, FINISH)]
    return {f.kpi: f.value for f in takt(made(rows, p), p)}


def test_a_gap_of_exactly_takt_keeps_it_and_the_job_before_the_window_counts():
    assert attained([15, 25, 35, 50, 51], plan(EVERY_10)) == {"takt_s": 10, "takt_attainment": 3 / 4}


def test_one_job_has_no_gap():
    assert isnan(attained([30], plan(EVERY_10))["takt_attainment"])


def test_a_saturated_source_asks_for_no_takt():
    assert attained([30], plan(line(2, 1, horizon="1100 s"))) == {}


def test_what_leaves_a_queue_is_poisson_too():
    """Burke 1956: gaps between departures of M/M/1 are exponential with the mean of the arrivals."""
    p = plan(queue(horizon="12000 s", seed=8))
    share = {f.kpi: f.value for f in takt(run_plan(p), p)}["takt_attainment"]
    expected = 1 - exp(-1)
    assert share == pytest.approx(expected, abs=4 * sqrt(expected * (1 - expected) / (11000 / 1.25)))


MORNING = """
opsim: 1
name: a source with hours
run: {start: Mon 06:00, horizon: 6 h}
layout: {places: {here: [0 m, 0 m]}}
shifts: {morning: {from: 06:00, to: 07:00}, day: {from: 06:00, to: 12:00}}
tasks: {weld: {fixed: 5 min}}
stations: {s1: {at: here, tasks: [weld]}}
products: {part: {route: [s1]}}
release: {kind: renewal, every: {fixed: 1 min}, shift: morning}
workers: {ana: {shift: day, skills: {s1: 1.0}}}
"""


def test_the_hours_in_which_the_floor_works_are_there_for_what_came_in_an_hour():
    """60 jobs come in the first of 6 hours; one every 6 min would do, and one leaves every 5 min."""
    p = plan(MORNING)
    found = {f.kpi: f.value for f in takt(run_plan(p), p)}
    assert found == {"takt_s": pytest.approx(360), "takt_attainment": 1}


def test_gaps_longer_than_takt_miss_it_long_after_the_last_job_came():
    p = plan(MORNING.replace("fixed: 5 min", "fixed: 7 min"))
    assert {f.kpi: f.value for f in takt(run_plan(p), p)} == {"takt_s": pytest.approx(360), "takt_attainment": 0}


def test_two_sources_together_are_as_quick_as_both():
    sources = [SimpleNamespace(job_every_s=lambda horizon_s, every_s=every_s: every_s) for every_s in (10.0, 15.0)]
    assert _takt_s(SimpleNamespace(sources=sources, horizon_s=100.0), None) == pytest.approx(6.0)


@pytest.mark.parametrize(("text", "kpi", "bound", "at_least"), [
    ("480 a day", "", 480, True),
    ("12.5 jobs per day", "", 12.5, True),
    ("throughput_per_h >= 60", "throughput_per_h", 60, True),
    ("time_in_system_s<=3600", "time_in_system_s", 3600, False),
])  # fmt: skip
def test_a_target_is_read(text, kpi, bound, at_least):
    target = read_target(text)
    assert (target.asked.kpi, target.bound, target.at_least) == (kpi, bound, at_least)
    assert read_target(target.words) == target


def test_a_target_of_one_worker_names_him():
    target = read_target("rula_from_5_min_per_h/ana/at_most <= 10")
    assert (target.asked.subject, target.asked.part) == ("ana", "at_most")


@pytest.mark.parametrize(("text", "words"), [
    ("throughput_per_hour >= 60", "did you mean 'throughput_per_h'"),
    ("480", "480 a day"),
    ("throughput_per_h > 60", "throughput_per_h >= 60"),
    ("throughput_per_h >= many", "expected a target, found"),
    ("", "expected a target, found"),
])  # fmt: skip
def test_what_is_no_target_is_answered_with_how_one_is_written(text, words):
    with pytest.raises(ValueError, match=words):
        read_target(text)


SHARES = st.lists(st.floats(0, 1e6), min_size=1, max_size=30)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ([5, 5, 5], 0),
        ([0, 0, 9], 2 / 3),  # one has all: 1 - 1/3
        ([1, 3], 0.25),  # |1 - 3| twice over 4 pairs is 1; over twice the mean: 1 / (2 * 2)
        ([0, 0, 0], 0),
        ([7], 0),
        ([4, np.nan, 4], 0),
    ],
)
def test_known_answers(values, expected):
    assert gini(np.array(values, float)) == pytest.approx(expected)


def test_of_nobody_it_is_not_known_and_less_than_nothing_is_refused():
    assert np.isnan(gini(np.array([]))) and np.isnan(gini(np.array([np.nan])))
    with pytest.raises(ValueError, match="less than nothing, found -1"):
        gini(np.array([2.0, -1.0]))


@given(SHARES, st.floats(0.1, 10))
def test_it_is_the_mean_difference_of_all_pairs_and_knows_no_unit(values, factor):
    have = np.array(values)
    found = gini(have)
    assert 0 <= found <= 1 - 1 / have.size + 1e-9
    if have.sum() > 1e-3:
        pairs = np.abs(have[:, None] - have).mean()
        assert found == pytest.approx(pairs / (2 * have.mean()), abs=1e-9)
        assert gini(have * factor) == pytest.approx(found, abs=1e-9)


@pytest.mark.parametrize(("said", "unit", "found"), [
    (2, "1/h", 2.0), ("2 an hour", "1/h", 2.0), ("0.5/h", "1/h", 0.5), ("20 s", "s", 20.0), ("1 min 30 s", "s", 90.0),
    ("3 km", "m", 3000.0), ("2 h", "h", 2.0), ("5 %", "share", 0.05), (0.05, "share", 0.05),
    ("10 min/h", "min/h", 10.0),
    ("4.5", "1", 4.5),
])  # fmt: skip
def test_an_amount_is_read_in_the_figures_unit(said, unit, found):
    assert amount(said, unit, "figure") == pytest.approx(found)


@pytest.mark.parametrize(("said", "unit", "words"), [
    (2, "s", "2 has no unit"), ("2 s", "1/h", "is per hour: write 2"), ("2 m", "s", "is a length"),
    ("x", "1", "expected a"),
    ("3 s", "share", "is a share: write 0.05 or '5 %'"), ("1e999", "1/h", "expected a"),
    (True, "1/h", "a number"),
    ("2 h", "1", "has another unit, or none: write 2"),
])  # fmt: skip
def test_an_amount_in_a_wrong_unit_is_refused_in_words(said, unit, words):
    with pytest.raises(ValueError, match=words):
        amount(said, unit, "the figure")


def test_per_cent_are_of_the_base_unless_the_figure_is_in_per_cent():
    assert (percent("2 %", "1/h"), percent("2 %", "share"), percent("2", "1/h")) == (0.02, None, None)


def test_a_limit_is_read_with_its_tolerance():
    found = read_limit("rula_from_5_min_per_h/worst <= 10 +- 0.5")
    assert found == LimitText(Asked("rula_from_5_min_per_h", "worst", "", "less"), "<=", "10", "0.5")
    assert bounds(found, "min/h") == (10.0, 0.5)
    assert bounds(read_limit("time_in_system_s <= 20 min"), "s") == (1200.0, 24.0)


@pytest.mark.parametrize(("text", "words"), [
    ("throughput_per_h > 60", "no limit"), ("walked <= 3", "did you mean 'walked_m'"),
    ("late_share <= 0", "how near is"),
    ("throughput_per_h >= 3 %", "per cent of what"), ("late_share <= 5 % +- 0", "a tolerance is more than 0"),
    ("time_in_system_s <= 20", "20 has no unit"),
])  # fmt: skip
def test_a_limit_that_is_none_is_refused_in_words(text, words):
    with pytest.raises(ValueError, match=words):
        read_limit(text)


def test_an_indifference_of_nothing_is_refused():
    for said in (0, -1, "0 %"):
        with pytest.raises(ValueError, match="expected more than 0"):
            check_indifference(said, "throughput_per_h")


@pytest.mark.parametrize(("kpi", "unit"), [
    ("throughput_per_h", "1/h"), ("rula_from_5_min_per_h", "min/h"), ("energy_kcal_per_min", "kcal/min"),
    ("time_in_system_s", "s"), ("walked_m", "m"), ("late_share", "share"), ("on_duty_h", "h"), ("rula_mean", ""),
])  # fmt: skip
def test_the_unit_is_in_the_name(kpi, unit):
    assert unit_of(kpi) == unit


@given(st.text(max_size=40))
def test_any_text_is_a_limit_or_is_refused_in_words(text):
    for said in (text, f"throughput_per_h <= {text}", f"rula_mean <= 3 +- {text}"):
        try:
            bound, tolerance = bounds(read_limit(said), "1/h")
        except ValueError as error:
            assert str(error)
        else:
            assert bound == bound and tolerance > 0
