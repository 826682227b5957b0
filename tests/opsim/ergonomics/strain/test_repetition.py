"""Repeated work, counted from rows alone."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from plans import ran

from opsim.ergonomics.strain.posture_limits import begun, repeated_rows
from opsim.kpi.strain import repetitions
from opsim.log import COLUMNS, SETUP, WAIT
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan
from tests.opsim.kpi.made_logs import made, row, work

PLAN = made_plan()


def log_of(begins, worker=0, task=BEND, lasting=1.0):
    return made([work(t, t + lasting, 0, worker=worker, task=task, k=k) for k, t in enumerate(begins)], PLAN)


def test_four_beginnings_in_a_minute_are_repeated_work():
    """0, 15, 30, 45: three cycles of 15 s are 4 a minute. The fifth, 46 s later, makes 4 in 76 s with those before."""
    assert repeated_rows(log_of([0, 15, 30, 45, 91])).tolist() == [True] * 4 + [False]


def test_a_cycle_of_15_seconds_is_4_a_minute_and_a_longer_one_is_not():
    """A cycle of 16 s is 3.75 a minute, one of 20 s is 3, though four of them begin within a minute."""
    assert repeated_rows(log_of(15.0 * np.arange(9))).all() and repeated_rows(log_of(0.1 + 15.0 * np.arange(9))).all()
    for cycle_s in (15.1, 16.0, 19.9, 20.0):
        assert not repeated_rows(log_of(cycle_s * np.arange(9))).any()
    assert repeated_rows(log_of([0, 1, 2, 45])).all() and not repeated_rows(log_of([0, 1, 2, 45.1])).any()


def test_attended_runs_of_two_stations_are_each_a_beginning():
    """Two stations that one worker attends in turn count their own runs: k is 0, 0, 1, 1."""
    rows = [work(10 * i, 10 * i + 9, i % 2, worker=0, task=BEND, k=i // 2) for i in range(6)]
    log = made(rows, PLAN)
    assert begun(log).size == 6 and repeated_rows(log).all()


def test_a_performance_that_somebody_helps_with_begins_once():
    """Its parts go at paces of their own and have numbers of their own (``performance_id``), but one k."""
    rows = [list(work(10 * i, 10 * i + 10, 0, worker=0, k=0, progress=(i / 4, (i + 1) / 4))) for i in range(4)]
    for number, one in enumerate(rows):
        one[list(COLUMNS).index("performance_id")] = number
    log = made([tuple(one) for one in rows], PLAN)
    assert len(set(log["performance_id"])) == 4 and begun(log).size == 1


ATTENDED = """
opsim: 1
name: attended
run: {horizon: 10 min}
layout: {places: {a: [0 m, 0 m]}}
tasks: {mill: {fixed: 10 s, automatic: attended}}
stations: {s0: {at: a, tasks: [mill], buffer: 1}, s1: {at: a, tasks: [mill], buffer: 1}}
products: {p: {route: [ROUTE]}}
release: {kind: saturated}
workers: {ana: {skills: {s0: 1.0, s1: 1.0}}}
outputs: [repetitions_per_min]
"""


@pytest.mark.parametrize("route", ["s0", "s0, s1"])
def test_who_attends_runs_of_ten_seconds_does_six_a_minute_at_however_many_stations(route):
    log, plan = ran(ATTENDED.replace("ROUTE", route))
    found = {(f.subject, f.part): f.value for f in repetitions(log, plan)}
    assert found["ana", ""] == pytest.approx(6.0) and found["ana", "most"] == pytest.approx(6.0)


def test_workers_and_tasks_are_counted_each_by_itself():
    rows = [work(10 * i, 10 * i + 1, 0, worker=i % 2, task=BEND, k=i) for i in range(6)]
    assert not repeated_rows(made(rows, PLAN)).any()
    rows = [work(10 * i, 10 * i + 1, 0, worker=0, task=(BEND, COUNT)[i % 2], k=i) for i in range(6)]
    assert not repeated_rows(made(rows, PLAN)).any()


def test_pieces_of_one_performance_are_one_beginning():
    pieces = [work(10 * i, 10 * i + 5, 0, worker=0, k=0, progress=(i / 4, (i + 1) / 4)) for i in range(4)]
    assert not repeated_rows(made(pieces, PLAN)).any()


def test_a_later_piece_is_marked_as_its_performance():
    rows = [work(t, t + 1, 0, worker=0, k=k) for k, t in enumerate((0, 5, 10))]
    rows += [work(15, 16, 0, worker=0, k=3, progress=(0, 0.5)), work(500, 501, 0, worker=0, k=3, progress=(0.5, 1))]
    assert repeated_rows(made(rows, PLAN)).all()


def test_only_work_of_workers_is_repeated():
    rows = [row(WAIT, t, t + 1, worker=0) for t in range(6)] + [work(t, t + 1, 0, task=BEND, k=t) for t in range(6)]
    assert not repeated_rows(made(rows, PLAN)).any()
    rows = [row(SETUP, t, t + 1, worker=0, station=0, task=BEND, k=t, progress=(0, 1)) for t in range(6)]
    assert repeated_rows(made(rows, PLAN)).all()


def naive(log, times=4):
    """Any four beginnings of one worker and task whose rate, cycles over the time they take, is 4 a minute or more."""
    begins = [(log["worker"][i], log["task"][i], log["start_s"][i]) for i in range(len(log))]
    found = np.zeros(len(log), bool)
    for some in combinations(range(len(log)), times):
        times_s = [begins[i][2] for i in some]
        alike = len({begins[i][:2] for i in some}) == 1
        if alike and (times - 1) * 60 >= times * (max(times_s) - min(times_s)):
            found[list(some)] = True
    return found


events = st.tuples(st.integers(0, 1), st.sampled_from([BEND, COUNT]), st.integers(0, 150))


@given(st.lists(events, max_size=16, unique_by=lambda e: (e[0], e[2])))
def test_sliding_is_the_naive_counting(begins):
    rows = [work(t, t + 1, 0, worker=w, task=task, k=k) for k, (w, task, t) in enumerate(begins)]
    log = made(rows, replace(PLAN))
    assert np.array_equal(repeated_rows(log), naive(log))
