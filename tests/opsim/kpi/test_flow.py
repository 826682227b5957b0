"""What comes out, how long it stays, how much is inside."""

from dataclasses import replace

import numpy as np
import pytest
from plans import line, plan

from opsim.engine.floor import run_plan
from opsim.kpi.throughput import time_in_system, work_in_progress
from opsim.log import CREATE, FINISH
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
