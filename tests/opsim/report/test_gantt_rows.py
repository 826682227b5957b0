from itertools import pairwise

import numpy as np
import pytest
from plans import CELL, line, plan, ran

from opsim.kpi.states import STATES, states_of_rows
from opsim.laws.capacity import ON_SERVER
from opsim.log import BLOCKED, DOWN, HELD, IDLE, NO_WORKER, WAIT, WALK
from opsim.plan.stores import jobs_on_a_server
from opsim.report.sections.gantt_rows import NOT_DRAWN, of_workers, on_servers, standing, typical_hour_s
from tests.opsim.kpi.made_logs import made, row, work

TWO = line(2, 0, horizon="100 s", warm_up="0 s")
ROWS = [
    work(0, 10, 0, job=0, worker=0),
    work(10, 15, 0, job=0, worker=0, task=1),
    row(BLOCKED, 15, 20, station=0, job=0),
    row(HELD, 20, 22, station=1, job=0, cause=NO_WORKER),
    work(22, 40, 1, job=0, worker=1),
    work(20, 60, 0, job=1, worker=0),
    row(DOWN, 70, 90, station=1),
    row(WALK, 15, 18, worker=0, places=(0, 0)),
    row(WAIT, 40, 100, worker=1, cause=IDLE),
]


@pytest.fixture(scope="module")
def cell():
    return ran(CELL)


def test_a_state_of_a_job_is_one_bar_whatever_its_tasks():
    p = plan(TWO)
    found = [
        (s.row, s.what, s.start_s, s.end_s, s.job, s.cause) for s in on_servers(made(ROWS, p), p, 5, 90).between(5, 90)
    ]
    assert found == [
        (0, "work", 5, 15, 0, ""),
        (0, "blocked", 15, 20, 0, ""),
        (0, "work", 20, 60, 1, ""),
        (1, "held", 20, 22, 0, "worker"),
        (1, "work", 22, 40, 0, ""),
    ]


def test_a_station_that_is_down_is_a_bar_of_its_own():
    p = plan(TWO)
    assert [(s.row, s.what, s.start_s, s.end_s) for s in standing(made(ROWS, p), p, 0, 80)] == [(1, "down", 70, 80)]


def test_workers_show_work_and_walks_and_no_idleness():
    p = plan(TWO)
    found = [(s.row, s.what, s.start_s, s.end_s) for s in of_workers(made(ROWS, p), 0, 100).between(0, 100)]
    assert found == [(0, "work", 0, 15), (0, "walk", 15, 18), (0, "work", 20, 60), (1, "work", 22, 40)]


def test_bars_of_a_station_never_overlap_in_a_lane_nor_have_more_lanes_than_servers(cell):
    log, p = cell
    lanes = {}
    for one in on_servers(log, p, 0, p.horizon_s).between(0, p.horizon_s):
        most = p.stations[one.row].servers * jobs_on_a_server(p, one.row)
        assert one.lane < one.lanes <= most
        lanes.setdefault((one.row, one.lane), []).append((one.start_s, one.end_s))
    assert len(lanes) == sum(station.servers for station in p.stations)
    for spans in lanes.values():
        spans.sort()
        assert all(end <= start + 1e-6 for (_, end), (start, _) in pairwise(spans))


def test_bars_hold_all_the_time_that_the_rows_have(cell):
    log, p = cell
    on = np.isin(log["kind"], ON_SERVER) & (log["job"] >= 0) & (log["station"] >= 0)
    drawn = sum(s.end_s - s.start_s for s in on_servers(log, p, 0, p.horizon_s).between(0, p.horizon_s))
    assert drawn == pytest.approx((log["end_s"] - log["start_s"])[on].sum())
    rows, state = states_of_rows(log)
    shown = ~np.isin(state, [STATES.index(name) for name in NOT_DRAWN])
    people = sum(s.end_s - s.start_s for s in of_workers(log, 0, p.horizon_s).between(0, p.horizon_s))
    assert people == pytest.approx((log["end_s"] - log["start_s"])[rows[shown]].sum())


def test_as_many_are_counted_as_are_made(cell):
    log, p = cell
    for found in (on_servers(log, p, 0, p.horizon_s), of_workers(log, 0, p.horizon_s)):
        for span in ((0.0, 600.0), (1000.0, 1010.0), (0.0, p.horizon_s)):
            assert found.count(*span) == len(found.between(*span))


def test_the_hour_is_the_first_one_with_as_much_work_as_is_usual():
    hours = line(2, 0, horizon="6 h", warm_up="30 min")
    p = plan(hours)
    shares = [3000, 100, 900, 1000, 1100, 900]
    rows = [work(3600 * n, 3600 * n + s, 0, job=n, worker=0) for n, s in enumerate(shares)]
    assert typical_hour_s(made(rows, p), p) == (3600 * 2, 3600 * 3)
    assert typical_hour_s(made([], p), p) == (3600, 7200)
    short = plan(line(2, 0, horizon="40 min", warm_up="10 min"))
    assert typical_hour_s(made(rows[:1], short), short) == (600, 2400)
