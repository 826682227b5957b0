"""The rhythm that demand asks for."""

from math import exp, isnan, sqrt
from types import SimpleNamespace

import pytest
from plans import line, plan, queue

from opsim.engine.floor import run_plan
from opsim.kpi.throughput import _takt_s, takt
from opsim.log import CREATE, FINISH
from tests.opsim.kpi.made_logs import made, row

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
