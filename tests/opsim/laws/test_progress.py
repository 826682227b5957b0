"""Work done twice, left out, or at two paces is found; what rules of interruption leave behind is right."""

import pytest
from plans import plan, ran

from opsim.laws.jobs import Stays, progress
from opsim.log import CREATE, FINISH, SETUP
from tests.opsim.kpi.made_logs import made, row, work

FLOOR = """
opsim: 1
name: progress
run: {start: Mon 06:00, horizon: 100 s}
layout: {places: {here: [0 m, 0 m]}}
shifts: {day: {from: 06:00, to: 14:00}}
tasks: {t: {fixed: 10 s}, u: {fixed: 10 s}}
stations: {a: {at: here, tasks: [t], buffer: 3}, b: {at: here, tasks: [u]}}
products: {p: {route: [a, b]}}
release: {kind: poisson, every: 10 s}
workers: {ana: {shift: day, skills: {a: 1.0, b: 1.0}}, ben: {skills: {a: 1.0}}}
"""


def found(*rows, text=FLOOR):
    p = plan(text)
    log = made(rows, p)
    return list(progress(log, p, Stays(log)))


def piece(start, end, begun, done, *, worker=0, performance=0, station=0):
    return work(start, end, station, worker=worker, task=station, k=performance, progress=(begun, done))


def test_a_performance_in_pieces_adds_up_to_one():
    assert found(piece(0, 4, 0, 0.4), piece(50, 56, 0.4, 1)) == []


def test_another_worker_goes_on_with_a_performance_of_his_own_at_his_own_pace():
    assert found(piece(0, 4, 0, 0.4), piece(50, 62, 0.4, 1, worker=1, performance=1)) == []


@pytest.mark.parametrize("begun", [0.3, 0.5, 1e-9])
def test_a_piece_that_begins_elsewhere_than_the_one_before_ended_is_found(begun):
    (complaint,) = found(piece(0, 4, 0, 0.4), piece(50, 50 + 10 * (1 - begun), begun, 1, performance=1))
    assert "where 0.4 was done" in complaint


def test_work_that_begins_in_the_middle_is_found():
    assert "where 0 was done" in found(piece(0, 5, 0.5, 1))[0]


def test_work_that_is_done_anew_is_found_where_no_rule_lets_it():
    twice = piece(0, 4, 0, 0.4), piece(50, 60, 0, 1, performance=1)
    assert len(found(*twice)) == 1
    for rule in ("at_break: restart", "at_end: restart"):
        assert found(*twice, text=FLOOR.replace("to: 14:00", f"to: 14:00, {rule}")) == []
    assert found(*twice, text=FLOOR.replace("t: {fixed: 10 s}", "t: {fixed: 10 s, interruption: restart}")) == []


def test_a_rule_of_one_worker_is_no_excuse_for_another():
    of_ben = piece(0, 4, 0, 0.4, worker=1), piece(50, 60, 0, 1, worker=1, performance=1)
    assert len(found(*of_ben, text=FLOOR.replace("to: 14:00", "to: 14:00, at_break: restart"))) == 1


def test_the_next_task_before_the_last_one_is_done_is_found():
    assert found(piece(0, 10, 0, 1), piece(20, 30, 0, 1, performance=1, station=1)) == []
    assert found(piece(0, 4, 0, 0.4), piece(20, 30, 0, 1, performance=1, station=1)) != []


def test_a_job_that_leaves_half_done_is_found():
    leaves = row(CREATE, 0, 0, job=0), row(FINISH, 60, 60, job=0)
    assert found(piece(0, 10, 0, 1), *leaves) == []
    assert "not done" in found(piece(0, 4, 0, 0.4), *leaves)[0]


def test_a_set_up_may_begin_anew():
    ups = [row(SETUP, at, at + 4, worker=0, station=0, job=0, task=0, k=at, progress=(0, 0.4)) for at in (0, 20)]
    assert found(*ups) == []


def test_progress_beyond_the_whole_or_backwards_is_found():
    assert "a piece goes from 0 to 1.2" in found(piece(0, 12, 0, 1.2))[0]
    assert "a piece goes from 0.5 to 0.5" in found(piece(0, 12, 0.5, 0.5))[0]


def test_one_performance_goes_at_one_pace():
    (complaint,) = found(piece(0, 4, 0, 0.4), piece(50, 57, 0.4, 1))
    assert "0.4 of it took 4 s of 11 s" in complaint


@pytest.mark.parametrize("rule", ["finish", "finish_job", "resume", "resume_any", "hand_over", "restart"])
def test_every_rule_of_interruption_obeys_the_law(rule):
    text = (
        FLOOR.replace("horizon: 100 s", "horizon: 2 h")
        .replace("to: 14:00", f"to: 07:30, at_break: {rule}, breaks: {{a: {{at: 06:20, lasts: 7 min}}}}")
        .replace("fixed: 10 s", "dist: lognormal, mean: 100 s, cv: 0.5")
    )
    log, p = ran(text)
    assert list(progress(log, p, Stays(log))) == []
