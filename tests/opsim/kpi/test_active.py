"""Active periods of stations."""

import numpy as np
import pytest
from plans import CELL, line, plan

from opsim.engine.floor import run_plan
from opsim.kpi.states import active_periods, active_time
from opsim.log import WORK
from tests.opsim.kpi.made_logs import made, work

TWO_SERVERS = """
opsim: 1
name: two servers and one
run: {horizon: 100 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {a: {at: here, tasks: [t], servers: 2, buffer: 0}, b: {at: here, tasks: [t], buffer: 0}}
products: {p: {route: [a, b]}}
release: {kind: saturated}
"""


def periods(rows, p):
    found = active_periods(made(rows, p), p)
    return list(zip(found.station.tolist(), found.start_s.tolist(), found.end_s.tolist()))


def test_a_period_runs_from_job_to_job_and_ends_with_a_wait():
    p = plan(TWO_SERVERS)
    assert periods([work(0, 10, 1), work(10, 15, 1, job=1), work(16, 30, 1, job=2)], p) == [(1, 0, 15), (1, 16, 30)]


def test_a_station_of_two_servers_is_active_while_both_work():
    p = plan(TWO_SERVERS)
    rows = [work(0, 10, 0), work(5, 15, 0, job=1), work(10, 12, 0, job=2), work(14, 20, 0, job=3)]
    assert periods(rows, p) == [(0, 5, 12), (0, 14, 15)]


def test_no_work_is_no_period():
    p = plan(TWO_SERVERS)
    assert periods([], p) == []
    assert all(np.isnan(figure.value) for figure in active_time(made([], p), p))


def test_periods_that_end_in_the_warm_up_do_not_count_and_others_count_whole():
    p = plan(TWO_SERVERS)
    rows = [work(0, 5, 1), work(10, 30, 1, job=1), work(50, 60, 1, job=2)]
    assert {f.subject: f.value for f in active_time(made(rows, p), p)}["b"] == 15


@pytest.mark.parametrize("text", [CELL, line(4, 1, horizon="1500 s")])
def test_of_one_server_the_periods_hold_all_of_its_work_and_do_not_meet(text):
    p = plan(text)
    log = run_plan(p)
    found = active_periods(log, p)
    for rank, station in enumerate(p.stations):
        here = found.station == rank
        assert np.all(found.start_s[here][1:] > found.end_s[here][:-1])
        if station.servers == 1:
            worked_s = log.duration_s[(log["kind"] == WORK) & (log["station"] == rank)].sum()
            assert (found.end_s - found.start_s)[here].sum() == pytest.approx(worked_s)
