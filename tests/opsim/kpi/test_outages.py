"""How often stations stop, how long, and until when nobody repaired."""

from math import isnan

import numpy as np
import pytest
from plans import plan

from opsim.kpi.resources import Stretches
from opsim.log import BREAKDOWN, CREATE, DOWN, MAINTENANCE, REPAIR, SCRAP, SETUP
from tests.opsim.kpi.made_logs import found, made, row, work

SHOP = """
opsim: 1
name: shop
run: {horizon: 3620 s, warm_up: 20 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations:
  a:
    at: here
    tasks: [t]
    servers: 2
    setup: {otherwise: 5 s, attended: false}
    scrap: 0.1
    breakdowns: {jam: {every: {fixed: 50 s}, repair: {fixed: 10 s}, team: men}}
    maintenance: {oil: {every: 100 s, lasts: 5 s}}
  b: {at: here, tasks: [t]}
repair_teams: {men: {}}
products: {p: {route: [a, b]}}
release: {kind: poisson, every: 20 s}
"""


def stop(kind, start, end, cause=BREAKDOWN, k=0):
    p = plan(SHOP)
    task = next(one.task for one in (p.breakdowns if cause == BREAKDOWN else p.maintenance))
    return row(kind, start, end, station=0, task=task, k=k, cause=cause)


def values(*rows):
    p = plan(SHOP)
    return found(made(rows, p), p)


STOPS = [
    stop(REPAIR, 0, 10),
    stop(DOWN, 100, 130, k=1),
    stop(REPAIR, 130, 140, k=1),
    stop(REPAIR, 200, 260, MAINTENANCE),
    stop(DOWN, 400, 410, k=2),
    stop(REPAIR, 410, 500, k=2),
    stop(DOWN, 3600, 3620, k=3),
]


def test_stops_are_counted_where_they_begin_and_timed_where_they_end():
    """In the window two breakdowns end, of 40 s and 100 s, and a third begins; 160 s of breakdowns, 60 of care."""
    figures = values(*STOPS)
    assert figures["stops_per_h", "a", "breakdown"] == 3 and figures["stops_per_h", "a", "maintenance"] == 1
    assert figures["down_s", "a", "breakdown"] == 70 and figures["down_s", "a", "maintenance"] == 60
    assert figures["wait_for_repair_s", "a", "breakdown"] == 20
    assert figures["mean_time_between_failures_s", "a", ""] == (3600 - 160 - 60) / 3


def test_a_station_that_cannot_stop_says_nothing_and_one_that_did_not_has_no_mean():
    figures = values()
    assert not [key for key in figures if key[0] == "stops_per_h" and key[1] == "b"]
    assert figures["stops_per_h", "a", "breakdown"] == 0 and isnan(figures["down_s", "a", "breakdown"])


def test_seconds_that_meet_an_outage_are_found_in_one_go():
    outages = Stretches(np.array([10.0, 40.0]), np.array([20.0, 45.0]))
    from_s, to_s = np.array([0, 0, 15, 20, 12, 0]), np.array([5, 15, 42, 40, 18, 100])
    assert outages.meet_s(from_s, to_s).tolist() == [0, 5, 7, 0, 6, 15]


def test_oee_loses_breakdowns_and_set_ups_to_availability_and_scrap_to_quality():
    """Two servers, 7200 s; care takes 120 s of them out of the plan; stops 320 s, a set-up 80 s; 5 jobs, one scrap."""
    jobs = [work(1000 + 20 * n, 1016 + 20 * n, 0, job=n) for n in range(5)]
    scrap = row(SCRAP, 1096, 1096, station=0, job=4)
    created = [row(CREATE, 999, 999, job=n) for n in range(5)]
    figures = values(*STOPS, *jobs, *created, scrap, row(SETUP, 900, 980, station=0, job=0))
    factor = {part: value for (kpi, of, part), value in figures.items() if (kpi, of) == ("oee_factor", "a")}
    available_s = 7200 - 120 - 320 - 80
    assert factor["availability"] == pytest.approx(available_s / (7200 - 120))
    assert factor["performance"] == pytest.approx(50 / available_s)
    assert factor["speed"] == pytest.approx(50 / 80) and factor["use"] == pytest.approx(80 / available_s)
    assert factor["quality"] == pytest.approx(4 / 5)
    assert figures["oee", "a", ""] == pytest.approx(50 / (7200 - 120) * 4 / 5)
