"""Work at a station that is down is found, and so are outages that overlap."""

import pytest
from plans import plan

from opsim.laws.capacity import outages
from opsim.laws.jobs import Stays
from opsim.log import BLOCKED, BREAKDOWN, DOWN, MAINTENANCE, REPAIR, SETUP
from tests.opsim.kpi.made_logs import made, row, work

ONE = """
opsim: 1
name: one
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {a: {at: here, tasks: [t], servers: 2, buffer: 3}, b: {at: here, tasks: [t]}}
products: {p: {route: [a, b]}}
release: {kind: saturated}
"""
DOWN_20_TO_50 = [row(DOWN, 20, 30, station=0, cause=BREAKDOWN), row(REPAIR, 30, 50, station=0, cause=BREAKDOWN)]


def found(*rows):
    p = plan(ONE)
    log = made([*DOWN_20_TO_50, *rows], p)
    return list(outages(log, p, Stays(log)))


@pytest.mark.parametrize("begin, end", [(10, 20), (50, 60), (0, 5)])
def test_work_before_and_after_an_outage_is_right(begin, end):
    assert found(work(begin, end, 0), work(begin, end, 0, job=1)) == []


@pytest.mark.parametrize("begin, end", [(10, 21), (49, 60), (25, 28), (30, 45), (10, 90)])
def test_work_in_an_outage_is_found(begin, end):
    (complaint,) = found(work(begin, end, 0), work(60, 70, 0, job=1))
    assert complaint.startswith("station a: work goes on at ")


def test_a_set_up_is_work_and_a_blocked_job_is_none():
    assert found(row(SETUP, 25, 28, station=0, job=1)) != []
    assert found(row(BLOCKED, 10, 60, station=0, job=1)) == []


def test_another_station_goes_on():
    assert found(work(10, 60, 1)) == []


def test_two_outages_at_once_are_found():
    assert "is down already" in found(row(REPAIR, 40, 60, station=0, cause=MAINTENANCE))[0]
