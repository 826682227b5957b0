"""Repeated work, counted from rows alone."""

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from opsim.ergonomics.repetition import repeated_rows
from opsim.log import SETUP, WAIT
from tests.opsim.ergonomics.made_work import BEND, COUNT, made_plan
from tests.opsim.kpi.made_logs import made, row, work

PLAN = made_plan()


def log_of(begins, worker=0, task=BEND, lasting=1.0):
    return made([work(t, t + lasting, 0, worker=worker, task=task, k=k) for k, t in enumerate(begins)], PLAN)


def test_four_beginnings_in_a_minute_are_repeated_work():
    """0, 15, 30, 45: all within [0, 60). The fifth, at 61, has only 30 (no: 31 s before), 45 and itself: 3."""
    assert repeated_rows(log_of([0, 15, 30, 45, 91])).tolist() == [True] * 4 + [False]


def test_the_fourth_a_whole_minute_later_is_no_longer_in_it():
    assert not repeated_rows(log_of([0, 20, 40, 60])).any()
    assert repeated_rows(log_of([0, 20, 40, 59.9])).all()


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


def naive(log, times=4, within_s=60.0):
    """Every minute that begins with a beginning, and every beginning in it."""
    n = len(log)
    begins = [(log["worker"][i], log["task"][i], log["start_s"][i]) for i in range(n)]
    found = np.zeros(n, bool)
    for w, t, s in begins:
        inside = [i for i, (w2, t2, s2) in enumerate(begins) if (w2, t2) == (w, t) and s <= s2 < s + within_s]
        if len(inside) >= times:
            found[inside] = True
    return found


events = st.tuples(st.integers(0, 1), st.sampled_from([BEND, COUNT]), st.integers(0, 400))


@given(st.lists(events, max_size=40, unique_by=lambda e: (e[0], e[2])))
def test_sliding_is_the_naive_counting(begins):
    rows = [work(t, t + 1, 0, worker=w, task=task, k=k) for k, (w, task, t) in enumerate(begins)]
    log = made(rows, replace(PLAN))
    assert np.array_equal(repeated_rows(log), naive(log))
