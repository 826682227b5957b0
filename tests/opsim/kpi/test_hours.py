"""Scheduled hours, and figures that count them instead of the calendar's.

Hours on duty, overtime and absence, by hand; states of workers in shifts.
"""

import numpy as np
import pytest
from plans import plan

from opsim.kpi.window import duty_hours, elapsed_s, is_in, open_hours, station_hours
from opsim.log import (
    ABSENT,
    BREAK,
    BREAKDOWN,
    CREATE,
    DOWN,
    FINISH,
    HELD,
    JOB_BLOCKED,
    MEETING,
    OFF,
    QUEUE,
    REST,
    WAIT,
    WALK,
)
from opsim.subjects.shifts.figures import present_s
from opsim.subjects.shifts.hours import has_hours, scheduled
from tests.opsim.kpi.made_logs import found, made, row, work

H = 3600.0
FLOOR = """
opsim: 1
name: hours
run: {start: Mon 06:00, horizon: 10 h, warm_up: 1 h}
layout: {places: {here: [0 m, 0 m]}}
shifts: {early: {from: 07:00, to: 10:00}, late: {from: 12:00, to: 14:00}, office: {from: 09:00, to: 11:00}}
tasks: {t: {fixed: 10 s}}
stations:
  a: {at: here, tasks: [t], servers: 2, shift: office, breakdowns: {jam: {every: {fixed: 50 h}, repair: {fixed: 1 s}}}}
  b: {at: here, tasks: [t]}
products: {p: {route: [a, b]}}
release: {kind: poisson, every: 60 s}
workers: {ana: {shift: early, skills: {a: 1.0, b: 1.0}}, ben: {shift: late, skills: {a: 1.0, b: 1.0}}}
"""
PEOPLE = FLOOR.replace(", shift: office", "")
NOBODY = PEOPLE.replace("shift: early, ", "").replace("shift: late, ", "")
JAM = "breakdowns"


PEOPLES = ((H, 4 * H), (6 * H, 8 * H))
ONLY_A = FLOOR.replace("[a, b]", "[a]")
ALONE = ONLY_A.replace("fixed: 10 s", "fixed: 10 s, automatic: true")
TEAM = PEOPLE.replace("fixed: 10 s", "fixed: 10 s, team: 2").replace("from: 12:00", "from: 09:00")
CREW = PEOPLE.replace("release:", "crews: {all: {kind: bucket_brigade, stations: [a, b], workers: [ana]}}\nrelease:")


@pytest.mark.parametrize(
    ("text", "spans", "hours"),
    [
        pytest.param(
            FLOOR, PEOPLES, 5, id="a station without hours is always open, and works when its people are there"
        ),
        pytest.param(ONLY_A, ((3 * H, 4 * H),), 1, id="a station with hours, when its people are there too"),
        pytest.param(ALONE, ((3 * H, 5 * H),), 2, id="a machine needs nobody"),
        pytest.param(ALONE.replace(", shift: office", ""), ((0, 10 * H),), 9, id="nor has it to keep hours"),
        pytest.param(FLOOR.replace("every: 60 s", "every: 60 s, shift: office"), PEOPLES, 5, id="sources do not count"),
        pytest.param(TEAM, ((3 * H, 4 * H),), 1, id="a team, when there are enough of them"),
        pytest.param(CREW, ((H, 4 * H),), 3, id="members of crews alone at a crew's stations"),
        pytest.param(PEOPLE.replace("shift: late, ", ""), ((0, 10 * H),), 9, id="who has no shift is always there"),
        pytest.param(NOBODY, ((0, 10 * H),), 9, id="nobody and nothing keeps hours"),
    ],
)
def test_the_floor_is_open_while_a_station_on_a_route_may_work(text, spans, hours):
    assert scheduled(plan(text)) == spans and open_hours(plan(text)) == hours
    assert has_hours(plan(text)) is (text != NOBODY)


def test_hours_of_a_source_alone_leave_the_floor_open_all_the_time():
    text = NOBODY.replace("every: 60 s", "every: 60 s, shift: office")
    assert scheduled(plan(text)) == ((0, 10 * H),) and has_hours(plan(text))


def test_a_side_station_with_hours_does_not_close_the_floor():
    """Ana's bench is always open; 1 job in 100 goes to a bench that is open for an hour of six."""
    text = NOBODY.replace("tasks: [t]}\n", "tasks: [t], shift: office}\n").replace("[a, b]", "[a]")
    text = text.replace("{p: {route: [a]}}", "{p: {share: 0.99, route: [a]}, q: {share: 0.01, route: [b]}}")
    assert open_hours(plan(text)) == 9


def test_hours_of_one_station_and_of_one_worker():
    p = plan(FLOOR)
    assert station_hours(p, 0) == ((3 * H, 5 * H),) and station_hours(p, 1) == ((0, 10 * H),)
    assert duty_hours(p, 0) == ((H, 4 * H),)


def test_elapsed_time_stands_still_outside_of_the_spans():
    assert elapsed_s(((1.0, 3.0), (6.0, 7.0)), np.array([0, 1, 2, 4, 6.5, 9])).tolist() == [0, 0, 1, 2, 2.5, 3]
    assert elapsed_s((), np.array([4.0])).tolist() == [0]


def test_an_instant_is_in_a_time_from_after_its_beginning_to_its_end():
    assert is_in(((1.0, 3.0), (6.0, 7.0)), np.array([0.5, 1, 2, 3, 4, 7, 8])).tolist() == [0, 0, 1, 1, 0, 1, 0]
    assert is_in((), np.array([4.0])).tolist() == [False]


def jobs_done(*at_s):
    return [row(kind, s, s, job=n) for n, s in enumerate(at_s) for kind in (CREATE, FINISH)]


def test_throughput_counts_scheduled_hours_and_beside_it_those_of_the_calendar():
    for text, hours in ((ONLY_A, 1), (FLOOR, 5), (NOBODY, 9)):
        p = plan(text)
        values = found(made(jobs_done(2 * H, 3 * H, 4 * H), p), p)
        assert values["throughput_per_h", "", ""] == 3 / hours
        assert values["throughput_per_calendar_h", "", ""] == 3 / 9


def test_takt_is_scheduled_time_over_demand_and_nights_are_no_gap():
    p = plan(PEOPLE.replace("every: 60 s", "every: 60 s, shift: early"))
    values = found(made(jobs_done(4 * H - 20, 4 * H - 10), p), p)
    assert values["takt_s", "", ""] == 100  # 180 jobs come in 3 h, and the floor has 5 h for them
    p = plan(PEOPLE)  # jobs come for 10 h, and are made in 5 h
    values = found(made(jobs_done(4 * H - 10, 6 * H + 10, 6 * H + 50), p), p)
    assert values["takt_s", "", ""] == 30 and values["takt_attainment", "", ""] == 0.5


def test_what_leaves_outside_the_hours_keeps_no_takt():
    p = plan(PEOPLE)
    values = found(made(jobs_done(4 * H - 40, 4 * H - 9, 4 * H + 300, 5 * H, 6 * H + 10), p), p)
    assert values["takt_s", "", ""] == 30 and values["takt_attainment", "", ""] == 0.5  # gaps of 31 s and 10 s
    assert np.isnan(found(made(jobs_done(4 * H + 300, 5 * H), p), p)["takt_attainment", "", ""])


OFF_ROWS = [row(OFF, 0, 3 * H, station=0), row(OFF, 5 * H, 10 * H, station=0)]


def states(*rows, text=FLOOR):
    p = plan(text)
    values = found(made([*OFF_ROWS, *rows], p), p)
    return {part: 9 * 2 * v for (kpi, of, part), v in values.items() if (kpi, of) == ("station_states", "a")}


def test_a_station_is_closed_outside_its_hours_whatever_stands_there():
    hours = states(row(HELD, 4 * H, 6 * H, station=0, job=0), row(QUEUE, 0, 9 * H, station=0, job=1))
    assert hours["closed"] == 2 * (2 + 5) and hours["waiting"] == 1 and hours["starved"] == pytest.approx(3)
    assert sum(hours.values()) == pytest.approx(18)


def test_what_is_finished_after_closing_is_work():
    hours = states(work(4.5 * H, 5.5 * H, 0, worker=0))
    assert hours["work"] == 1 and hours["closed"] == 2 * 7 - 0.5 and sum(hours.values()) == pytest.approx(18)


def test_a_station_that_is_closed_is_not_down():
    jam = row(DOWN, 4 * H, 7 * H, station=0, task=1, k=0, cause=BREAKDOWN)
    hours = states(jam)
    assert hours["down"] == 2 and hours["closed"] == 14 and sum(hours.values()) == pytest.approx(18)
    p = plan(FLOOR)
    values = found(made([*OFF_ROWS, jam], p), p)
    assert values["oee_factor", "a", "availability"] == 0.5


DUTY_H = 3600
DUTY_FLOOR = """
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
    row(OFF, 0, DUTY_H, worker=0),
    row(WAIT, DUTY_H, 2 * DUTY_H, worker=0),
    work(2 * DUTY_H, 4 * DUTY_H, 0, worker=0),
    row(BREAK, 4 * DUTY_H, 4.5 * DUTY_H, worker=0),
    row(BREAK, 4.5 * DUTY_H, 5 * DUTY_H, worker=0, cause=MEETING),
    row(WAIT, 5 * DUTY_H, 6 * DUTY_H, worker=0),
    work(6 * DUTY_H, 7 * DUTY_H, 0, worker=0),
    row(OFF, 7 * DUTY_H, 10 * DUTY_H, worker=0),
    row(OFF, 0, 6 * DUTY_H, worker=1),
    row(ABSENT, 6 * DUTY_H, 9 * DUTY_H, worker=1),
    row(OFF, 9 * DUTY_H, 10 * DUTY_H, worker=1),
    row(WAIT, 0, 10 * DUTY_H, worker=2),
]


@pytest.fixture(scope="module")
def by_hand():
    p = plan(DUTY_FLOOR)
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
    p = plan(DUTY_FLOOR)
    rows = [row(BREAK, 5 * DUTY_H, 6 * DUTY_H, worker=0, cause=REST) if at == 5 else one for at, one in enumerate(ROWS)]
    assert found(made(rows, p), p)["duty_use", "ana", ""] == pytest.approx(3 / 4)


def test_who_has_no_shift_has_no_duty(by_hand):
    assert ("on_duty_h", "cem", "") not in by_hand


def test_an_hour_of_postures_is_one_in_which_somebody_is_there():
    p = plan(DUTY_FLOOR)
    assert (present_s(made(ROWS, p), p) / DUTY_H).tolist() == [5, 0, 8]


def test_overtime_before_one_shift_is_not_told_from_overtime_after_the_other():
    """Walks and waits outside of shifts count too: who is there is there."""
    p = plan(DUTY_FLOOR)
    rows = [
        row(WAIT, 5 * DUTY_H, 6 * DUTY_H, worker=0, cause=JOB_BLOCKED),
        row(WALK, 6 * DUTY_H, 6.5 * DUTY_H, worker=0, places=(0, 0)),
    ]
    assert found(made(rows, p), p)["overtime_h", "ana", ""] == 0.5


def test_a_floor_without_shifts_has_none_of_these_figures():
    p = plan(DUTY_FLOOR.replace("shift: day, ", "").replace("shift: late, ", ""))
    values = found(made([row(WAIT, 0, 10 * DUTY_H, worker=w) for w in range(3)], p), p)
    new = {"on_duty_h", "duty_use", "overtime_h", "absent_share", "interruptions_per_h"}
    assert not {kpi for kpi, _, _ in values} & new
    assert not {part for kpi, _, part in values if kpi == "worker_states"} & {"off", "break", "meeting", "absent"}
