"""Work a job gets in a visit to a station."""

from itertools import groupby

import numpy as np
import pytest
from plans import CELL, line, plan

from opsim.engine.floor import run_plan
from opsim.kpi.cycle_times import cycle_times, task_durations, visits
from opsim.log import WORK
from tests.opsim.kpi.made_logs import made, work

TWICE = """
opsim: 1
name: twice at one station
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true, repeat: 2}}
stations: {a: {at: here, tasks: [t], buffer: 0}}
products: {p: {route: [a, a]}}
release: {kind: saturated}
"""
ONE_OF_FIVE = """
opsim: 1
name: waits for a worker between two tasks
run: {horizon: 1 h}
layout: {places: {here: [0 m, 0 m]}}
tasks: {heat: {fixed: 10 s, automatic: true}, fit: {fixed: 60 s}}
stations: {a: {at: here, tasks: [heat, fit], servers: 5, buffer: 0}}
products: {p: {route: [a]}}
release: {kind: saturated}
workers: {w: {skills: {a: 1.0}}}
"""


def naive_cycle_times(log, p):
    """Job by job, station by station: the performances in time, cut after every visit's number of them."""
    rows = [{name: log[name][i] for name in log.columns} for i in range(len(log)) if log["kind"][i] == WORK]
    rows.sort(key=lambda row: (row["job"], row["station"], row["start_s"]))
    times = {station.name: [] for station in p.stations}
    for (_job, rank), stay in groupby(rows, key=lambda row: (row["job"], row["station"])):
        station = p.stations[rank]
        needed = sum(p.tasks[task].repeat for task in station.tasks)
        got_s, n_done = 0.0, 0
        for row in stay:
            got_s += row["end_s"] - row["start_s"]
            n_done += row["progress_to"] == 1
            if n_done == needed:
                if p.window_s[0] <= row["end_s"] < p.window_s[1]:
                    times[station.name].append(got_s)
                got_s, n_done = 0.0, 0
    return times


def test_two_visits_in_a_row_are_two():
    p = plan(TWICE)
    assert set(cycle_times(run_plan(p), p)["a"]) == {20.0}


def test_a_visit_under_way_at_the_horizon_does_not_count():
    p = plan(ONE_OF_FIVE)
    assert np.mean(cycle_times(run_plan(p), p)["a"]) == 70.0


def test_a_performance_in_two_pieces_is_one_and_begins_no_visit():
    p = plan(TWICE)
    pieces = [work(0, 4, 0, progress=(0.0, 0.4)), work(20, 26, 0, progress=(0.4, 1.0)), work(26, 36, 0)]
    next_visit = [work(36, 46, 0), work(46, 56, 0), work(56, 60, 0, job=1, progress=(0.0, 0.4))]
    log = made(pieces + next_visit, p)
    assert cycle_times(log, p)["a"].tolist() == [20, 20]
    assert visits(log, p).whole.tolist() == [True, True, False]
    assert task_durations(log, p)["t"].tolist() == [10, 10, 10]


def test_no_work_is_no_visit():
    p = plan(TWICE)
    assert cycle_times(made([], p), p)["a"].size == 0


@pytest.mark.parametrize(
    "text",
    [
        CELL,
        CELL.replace("[repack1, repack2], store]", "repack1, repack1, store, unload]"),
        TWICE,
        line(3, 0, horizon="1500 s"),
    ],
)
def test_visits_are_those_of_the_naive_twin(text):
    p = plan(text)
    log = run_plan(p)
    naive = naive_cycle_times(log, p)
    for station, seconds in cycle_times(log, p).items():
        assert np.sort(seconds) == pytest.approx(np.sort(naive[station]), abs=1e-9)
    assert sum(map(len, naive.values())) > 3
