"""The rhythm that demand asks for."""

from math import exp, isnan, sqrt

import pytest
from plans import line, plan, queue

from opsim.engine.simpy_engine import run_plan
from opsim.kpi.takt import takt
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
