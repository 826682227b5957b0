"""Trips and metres of each way: those of the figures."""

import numpy as np
import pytest
from plans import plan, ran

from opsim.kpi import figures
from opsim.log import WALK
from opsim.report.sections.common import walked_ways
from tests.opsim.kpi.made_logs import made, row
from tests.opsim.study.layout.made_floor import FLOOR


@pytest.fixture(scope="module")
def floor():
    return ran(FLOOR.replace("horizon: 1 h", "horizon: 1 h, warm_up: 10 min"))


def test_trips_both_ways_are_counted_together_by_worker():
    p = plan(FLOOR.replace("horizon: 1 h", "horizon: 30 min"))
    a, b = p.places.index("p1"), p.places.index("p5")
    rows = [
        row(WALK, 0, 20, worker=0, places=(a, b)),
        row(WALK, 20, 40, worker=0, places=(b, a)),
        row(WALK, 50, 70, worker=1, places=(a, b)),
        row(WALK, 80, 80, worker=1, places=(a, a)),
    ]
    found = walked_ways(made(rows, p), p)
    low, high = min(a, b), max(a, b)
    assert found.by_pair() == [(low, high, 6.0, pytest.approx(6 * 20.0))]
    assert list(found.shares(low, high)) == [(0, pytest.approx(2 / 3)), (1, pytest.approx(1 / 3))]


def test_trips_are_those_of_the_figures(floor):
    log, p = floor
    told = {}
    for one in figures(log, p, ["trips_per_h"]):
        if one.kpi == "trips_per_h" and one.part != "driven":
            key = frozenset(one.subject.split(" > "))
            told[key] = told.get(key, 0.0) + one.value
    found = {frozenset((p.places[a], p.places[b])): trips for a, b, trips, _ in walked_ways(log, p).by_pair() if trips}
    assert found == {key: pytest.approx(value) for key, value in told.items()} and len(found) > 2


def test_metres_of_each_worker_are_those_of_the_figures(floor):
    log, p = floor
    hours = 5 / 6
    told = [one.value for one in figures(log, p) if one.kpi == "walked_m" and one.subject]
    assert np.allclose(walked_ways(log, p).by_worker(len(p.workers)) * hours, told)


def test_where_nobody_walks_there_is_no_way():
    p = plan(FLOOR)
    assert walked_ways(made([], p), p).by_pair() == []
