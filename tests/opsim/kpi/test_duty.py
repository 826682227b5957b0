"""Hours on duty, overtime and absence, by hand; states of workers in shifts."""

import numpy as np
import pytest
from plans import plan

from opsim.kpi.workers import present_s
from opsim.log import ABSENT, BREAK, JOB_BLOCKED, MEETING, OFF, REST, WAIT, WALK
from tests.opsim.kpi.made_logs import found, made, row, work

H = 3600
FLOOR = """
opsim: 1
name: duty
run: {start: Mon 06:00, horizon: 10 h, warm_up: 2 h}
layout: {places: {here: [0 m, 0 m]}}
shifts: {day: {from: 07:00, to: 12:00}, late: {from: 12:00, to: 15:00}}
tasks: {t: {fixed: 10 s}}
stations: {a: {at: here, tasks: [t]}}
products: {p: {route: [a]}}
release: {kind: poisson, every: 60 s}
workers:
  ana: {shift: day, skills: {a: 1.0}}
  ben: {shift: late, skills: {a: 1.0}}
  cem: {skills: {a: 1.0}}
"""
ROWS = [
    row(OFF, 0, H, worker=0),
    row(WAIT, H, 2 * H, worker=0),
    work(2 * H, 4 * H, 0, worker=0),
    row(BREAK, 4 * H, 4.5 * H, worker=0),
    row(BREAK, 4.5 * H, 5 * H, worker=0, cause=MEETING),
    row(WAIT, 5 * H, 6 * H, worker=0),
    work(6 * H, 7 * H, 0, worker=0),
    row(OFF, 7 * H, 10 * H, worker=0),
    row(OFF, 0, 6 * H, worker=1),
    row(ABSENT, 6 * H, 9 * H, worker=1),
    row(OFF, 9 * H, 10 * H, worker=1),
    row(WAIT, 0, 10 * H, worker=2),
]


@pytest.fixture(scope="module")
def by_hand():
    p = plan(FLOOR)
    return found(made(ROWS, p), p)


@pytest.mark.parametrize(
    ("kpi", "subject", "part", "expected"),
    [
        ("on_duty_h", "ana", "", 5),
        ("on_duty_h", "ben", "", 0),
        ("on_duty_h", "", "", 5),
        ("duty_use", "ana", "", 3 / 4),
        ("overtime_h", "ana", "", 1),
        ("overtime_h", "ben", "", 0),
        ("absent_share", "ana", "", 0),
        ("absent_share", "ben", "", 1),
        ("absent_share", "", "", 3 / 7),
        ("worker_states", "ana", "work", 3 / 8),
        ("worker_states", "ana", "wait", 1 / 8),
        ("worker_states", "ana", "break", 0.5 / 8),
        ("worker_states", "ana", "meeting", 0.5 / 8),
        ("worker_states", "ana", "off", 3 / 8),
        ("worker_states", "ben", "absent", 3 / 8),
        ("worker_states", "ben", "off", 5 / 8),
        ("worker_states", "cem", "wait", 1),
        ("worker_states", "cem", "off", 0),
    ],
)
def test_a_figure_is_what_the_hand_finds(by_hand, kpi, subject, part, expected):
    assert by_hand[kpi, subject, part] == pytest.approx(expected)


def test_who_was_never_there_has_no_use(by_hand):
    assert np.isnan(by_hand["duty_use", "ben", ""])


def test_a_rest_by_need_is_time_in_which_he_might_have_worked():
    # 5 h there, 1 h of break and meeting: 3 h of work of 4, whether he waits in the other one or rests by need
    p = plan(FLOOR)
    rows = [row(BREAK, 5 * H, 6 * H, worker=0, cause=REST) if at == 5 else one for at, one in enumerate(ROWS)]
    assert found(made(rows, p), p)["duty_use", "ana", ""] == pytest.approx(3 / 4)


def test_who_has_no_shift_has_no_duty(by_hand):
    assert ("on_duty_h", "cem", "") not in by_hand


def test_an_hour_of_postures_is_one_in_which_somebody_is_there():
    p = plan(FLOOR)
    assert (present_s(made(ROWS, p), p) / H).tolist() == [5, 0, 8]


def test_overtime_before_one_shift_is_not_told_from_overtime_after_the_other():
    """Walks and waits outside of shifts count too: who is there is there."""
    p = plan(FLOOR)
    rows = [row(WAIT, 5 * H, 6 * H, worker=0, cause=JOB_BLOCKED), row(WALK, 6 * H, 6.5 * H, worker=0, places=(0, 0))]
    assert found(made(rows, p), p)["overtime_h", "ana", ""] == 0.5


def test_a_floor_without_shifts_has_none_of_these_figures():
    p = plan(FLOOR.replace("shift: day, ", "").replace("shift: late, ", ""))
    values = found(made([row(WAIT, 0, 10 * H, worker=w) for w in range(3)], p), p)
    new = {"on_duty_h", "duty_use", "overtime_h", "absent_share", "interruptions_per_h"}
    assert not {kpi for kpi, _, _ in values} & new
    assert not {part for kpi, _, part in values if kpi == "worker_states"} & {"off", "break", "meeting", "absent"}
