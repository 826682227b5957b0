"""A job that waits for one worker: who is at work elsewhere, or never was at the job, is found.

Work that begins at a closed station is found, and rows that close it in other hours than its calendar.

Work at a station that is down is found, and so are outages that overlap.

Times that learning and shifts do not give are found; those of the engine, in pieces or handed over, are right.

Work done twice, left out, or at two paces is found; what rules of interruption leave behind is right.

What stands where there is no place for it is found, at points of each kind.

More tools, cards, repair teams or vehicles in use than there are: each is found.
"""

from dataclasses import replace

import numpy as np
import pytest
from human_plans import LINE, planned, shipped, without_effects
from plans import plan
from plans import ran as ran_of_progress

from opsim.engine.floor.run import run_plan
from opsim.laws.audit import audit, shared
from opsim.laws.jobs import Stays, progress
from opsim.log import (
    AFTER,
    AWAY,
    BATCH,
    BLOCKED,
    BREAK,
    BREAKDOWN,
    CLOSED,
    CREATE,
    DOWN,
    FINISH,
    HELD,
    IS_DOWN,
    MAINTENANCE,
    OFF,
    PICKUP,
    QUEUE,
    REPAIR,
    REST,
    SETUP,
    STOCK,
    TOOL,
    TRANSPORT,
    WAIT,
    WALK,
    WORK,
    EventLog,
)
from opsim.subjects.breakdowns.figures import one_outage_at_a_time
from opsim.subjects.human.catalogue import made as made_of_pace
from opsim.subjects.human.figures import pace, rests, shifts
from opsim.subjects.shifts.laws import away, closed
from opsim.subjects.stations.figures import rooms
from tests.opsim.kpi.made_logs import made, row, work

BEGUN = work(0, 4, 0, worker=0, task=0, k=0, progress=(0, 0.4))
WAITS = row(HELD, 4, 50, station=0, job=0, cause=AWAY)


def found(*rows):
    p = plan(PROGRESS_FLOOR)
    log = made(rows, p)
    return list(away(log, p, Stays(log)))


def test_who_rests_and_comes_back_is_waited_for_with_right():
    rest = work(50, 56, 0, worker=0, task=0, k=0, progress=(0.4, 1))
    assert found(BEGUN, WAITS, row(BREAK, 4, 49, worker=0), rest) == []


def test_who_works_on_another_job_meanwhile_is_found():
    assert "waits for ana, who is at work elsewhere at 20 s" in found(BEGUN, WAITS, work(20, 30, 1, 1, worker=0))[0]
    assert found(BEGUN, WAITS, work(20, 30, 1, 1, worker=1)) == []


def test_who_is_back_and_idles_while_the_job_waits_for_him_is_found():
    there = row(WAIT, 20, 50, worker=0)
    assert (
        "waits for ana, who is there, and idle, at 20 s" in found(BEGUN, WAITS, row(BREAK, 4, 20, worker=0), there)[0]
    )
    on_the_way = row(WALK, 20, 50, worker=0, station=0, places=(1, 0))
    assert found(BEGUN, WAITS, row(BREAK, 4, 20, worker=0), on_the_way) == []


def test_a_job_that_nobody_has_begun_waits_for_nobody():
    assert "none has left work on it" in found(WAITS)[0]
    assert "none has left work on it" in found(work(0, 4, 0, worker=0, k=0), WAITS)[0]


FLOOR = """
opsim: 1
name: hours
run: {start: Mon 06:00, horizon: 3 h}
layout: {places: {here: [0 m, 0 m]}}
shifts: {hour: {from: 07:00, to: 08:00}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations: {a: {at: here, tasks: [t], servers: 2, buffer: 1, shift: hour}, b: {at: here, tasks: [t]}}
products: {p: {route: [a, b]}}
release: {kind: saturated}
"""
RESUME = FLOOR.replace("shift: hour}", "shift: hour, at_close: resume}")
SHUT = [row(OFF, 0, 3600, station=0), row(OFF, 7200, 10800, station=0)]


def closed_found(*rows, text=FLOOR, shut=SHUT):
    p = plan(text)
    log = made([*shut, *rows], p)
    return list(closed(log, p, Stays(log)))


@pytest.mark.parametrize("begin, end", [(3600, 7200), (5000, 5100)])
def test_work_in_open_hours_is_right(begin, end):
    assert closed_found(work(begin, end, 0)) == closed_found(work(begin, end, 0), text=RESUME) == []


def test_what_was_begun_may_be_finished_where_the_rule_says_so():
    assert closed_found(work(7000, 7300, 0)) == []
    assert "work goes on at 7200 s" in closed_found(work(7000, 7300, 0), text=RESUME)[0]


@pytest.mark.parametrize("begin, end", [(0, 10), (3599, 3700), (7200, 7300), (9000, 9100)])
def test_work_that_begins_while_it_is_closed_is_found(begin, end):
    (complaint,) = closed_found(work(begin, end, 0))
    assert complaint.startswith("station a: work goes on at")


def test_what_is_handed_over_after_closing_goes_on():
    pieces = work(7000, 7300, 0, progress=(0, 0.5)), work(7300, 7400, 0, k=1, progress=(0.5, 1))
    assert closed_found(*pieces) == []
    assert len(closed_found(pieces[0], work(7301, 7400, 0, k=1, progress=(0.5, 1)))) == 1


def test_what_was_broken_off_before_may_be_gone_on_with_in_the_instant_of_closing():
    pieces = work(7000, 7100, 0, progress=(0, 0.5)), work(7200, 7300, 0, k=1, progress=(0.5, 1))
    assert closed_found(*pieces) == []


HALF = work(7000, 7300, 0, progress=(0, 0.5))


def shut_in(begin, end, cause=CLOSED):
    return row(HELD, begin, end, station=0, job=0, cause=cause)


def test_what_was_begun_and_is_left_undone_since_the_station_is_closed_is_found():
    (complaint,) = closed_found(HALF, shut_in(7300, 10800))
    assert complaint == "station a: job 0 is left undone at 7300 s, though what was begun is finished there"
    assert closed_found(HALF, shut_in(7200, 10800), text=RESUME) != []  # the law of resume is another one
    assert "left undone" not in "".join(closed_found(HALF, shut_in(7300, 10800), text=RESUME))


def test_what_a_stop_of_the_station_breaks_off_may_wait_for_the_opening():
    stop = row(REPAIR, 7300, 7400, station=0)
    assert closed_found(HALF, shut_in(7300, 10800), stop) == []
    assert closed_found(HALF, shut_in(7300, 7400, IS_DOWN), shut_in(7400, 10800)) == []


def test_what_is_done_waits_for_its_next_task_until_the_opening():
    assert closed_found(work(7000, 7300, 0), shut_in(7300, 10800)) == []


@pytest.mark.parametrize("leaves, complaints", [("08:01:40", 0), ("08:01:41", 1)])
def test_who_has_to_go_may_leave_it_undone(leaves, complaints):
    text = FLOOR.replace(", automatic: true", "").replace(
        "hour: {from: 07", f"ana: {{from: 06:00, to: {leaves}}}, hour: {{from: 07"
    )
    text += "workers: {ana: {shift: ana, skills: {a: 1, b: 1}}}"
    rows = work(7000, 7300, 0, worker=0, progress=(0, 0.5)), shut_in(7300, 10800)
    assert len(closed_found(*rows, text=text)) == complaints


def test_a_set_up_is_work():
    assert len(closed_found(row(SETUP, 9000, 9100, station=0, job=0, progress=(0, 1)))) == 1


def test_another_station_goes_on_all_the_time():
    assert closed_found(work(0, 10000, 1)) == []


def test_rows_of_other_hours_than_the_calendars_are_found():
    assert "its calendar for 2 h" in closed_found(shut=SHUT[:1])[0]
    assert "though it is always open" in closed_found(shut=[*SHUT, row(OFF, 0, 9, station=1)])[0]


FATIGUE = "fatigue: {model: lffrm, tires_half_in: 10 min, recovers_half_in: 5 min, slows: 0.5}"


@pytest.fixture(scope="module")
def ran():
    plan = planned(LINE, f"human: {{{FATIGUE}, circadian: {{amplitude: 0.1}}, rest: {{above: 0.4, until: 0.2}}}}")
    return run_plan(plan), plan


def said(law, log, plan):
    return "; ".join(law(log, plan, None))


def with_column(log, name, change):
    columns = {**log.columns, name: log[name].copy()}
    change(columns[name])
    return replace(log, columns=columns)


def test_a_run_obeys_both_laws(ran):
    assert said(shifts, *ran) == said(rests, *ran) == ""


def test_a_shift_that_nobodys_day_made_is_found(ran):
    log, plan = ran
    row = np.flatnonzero(log["kind"] == WORK)[30]
    wrong = with_column(log, "pace_shift", lambda shift: shift.__setitem__(row, shift[row] + 1e-6))
    assert "log time is shifted by" in said(shifts, wrong, plan)


def test_it_is_not_asked_where_effects_are_plain_factors(ran):
    log, plan = ran
    wrong = with_column(log, "pace_shift", lambda shift: shift.fill(0.3))
    assert said(shifts, wrong, replace(plan, human=replace(plan.human, acts_on="time"))) == ""


def test_a_rest_of_somebody_who_is_not_tired_is_found(ran):
    log, plan = ran
    assert "and his fatigue was" in said(rests, log, replace(plan, human=replace(plan.human, rest=Levels(0.9, 0.2))))


def test_a_rest_that_ends_too_soon_is_found(ran):
    log, plan = ran
    row = np.flatnonzero((log["kind"] == BREAK) & (log["cause"] == REST))[0]
    wrong = with_column(log, "end_s", lambda end_s: end_s.__setitem__(row, end_s[row] - 5.0))
    assert "comes back with a fatigue of" in said(rests, wrong, plan)


def test_a_rest_that_nobody_takes_is_found(ran):
    log, plan = ran
    assert "nobody does" in said(rests, log, replace(plan, human=replace(plan.human, rest=None)))


class Levels:
    def __init__(self, above, until):
        self.above, self.until = above, until


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


def outages_found(*rows):
    p = plan(ONE)
    log = made([*DOWN_20_TO_50, *rows], p)
    return list(one_outage_at_a_time(log, p, Stays(log)))


@pytest.mark.parametrize("begin, end", [(10, 20), (50, 60), (0, 5)])
def test_work_before_and_after_an_outage_is_right(begin, end):
    assert outages_found(work(begin, end, 0), work(begin, end, 0, job=1)) == []


@pytest.mark.parametrize("begin, end", [(10, 21), (49, 60), (25, 28), (30, 45), (10, 90)])
def test_work_in_an_outage_is_found(begin, end):
    (complaint,) = outages_found(work(begin, end, 0), work(60, 70, 0, job=1))
    assert complaint.startswith("station a: work goes on at ")


def test_a_set_up_is_work_and_a_blocked_job_is_none():
    assert outages_found(row(SETUP, 25, 28, station=0, job=1)) != []
    assert outages_found(row(BLOCKED, 10, 60, station=0, job=1)) == []


def test_another_station_goes_on():
    assert outages_found(work(10, 60, 1)) == []


def test_two_outages_at_once_are_found():
    assert "is down already" in outages_found(row(REPAIR, 40, 60, station=0, cause=MAINTENANCE))[0]


ALL = """
human:
  learning: {model: de_jong, rate: 0.8, measured_at: 20}
  forgetting: {model: lfcm, forgotten_in: 20 d, least_pause: 90 s}
  state_pace: {model: schultz, faster: 0.2, slower: 0.1}
  circadian: {amplitude: 0.1}
"""
FLOORS = [
    *(("torque_guns", 3.0), ("relief_worker", 4.0), ("two_shift_plant", 7.0), ("bucket_brigade", 0.5)),
    *(("colour_changes", 8.0), ("moving_line", 1.0), ("paced_line", 1.0), ("skill_chain", 2.0)),
]


def complaints(log, plan):
    return list(pace(log, plan, Stays(log)))


@pytest.mark.parametrize(("name", "hours"), FLOORS)
def test_every_time_is_its_draw_times_what_the_effects_make_of_it(name, hours):
    plan = shipped(name, hours, ALL)
    log = run_plan(plan)
    assert np.unique(log["pace_shift"][log["kind"] == WORK]).size > 10
    audit(log, plan)


def changed(log, column, row, by):
    columns = dict(log.columns)
    columns[column] = columns[column].copy()
    columns[column][row] += by
    return EventLog(log.replication, log.horizon_s, columns, log.names)


@pytest.mark.parametrize(("column", "by"), [("pace_shift", 1e-3), ("start_s", 0.01), ("k", 64)])
def test_a_time_that_does_not_follow_is_found(column, by):
    plan = planned(LINE, ALL)
    log = run_plan(plan)
    row = np.flatnonzero(log["kind"] == WORK)[20]
    assert complaints(log, plan) == []
    (complaint,) = complaints(changed(log, column, row, by), plan)
    assert "its draw, learning and shift give" in complaint


def test_another_rate_of_learning_is_found():
    plan = planned(LINE, ALL)
    other = replace(plan, human=replace(plan.human, learning=made_of_pace("learning", "de_jong", {"rate": 0.9})))
    assert complaints(run_plan(plan), other) != []


def test_nothing_is_asked_where_nothing_acts_on_times():
    plan = planned(LINE, ALL)
    assert complaints(run_plan(plan), without_effects(plan)) == []


PROGRESS_FLOOR = """
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


def progress_found(*rows, text=PROGRESS_FLOOR):
    p = plan(text)
    log = made(rows, p)
    return list(progress(log, p, Stays(log)))


def piece(start, end, begun, done, *, worker=0, performance=0, station=0):
    return work(start, end, station, worker=worker, task=station, k=performance, progress=(begun, done))


def test_a_performance_in_pieces_adds_up_to_one():
    assert progress_found(piece(0, 4, 0, 0.4), piece(50, 56, 0.4, 1)) == []


def test_another_worker_goes_on_with_a_performance_of_his_own_at_his_own_pace():
    assert progress_found(piece(0, 4, 0, 0.4), piece(50, 62, 0.4, 1, worker=1, performance=1)) == []


@pytest.mark.parametrize("begun", [0.3, 0.5, 1e-9])
def test_a_piece_that_begins_elsewhere_than_the_one_before_ended_is_found(begun):
    (complaint,) = progress_found(piece(0, 4, 0, 0.4), piece(50, 50 + 10 * (1 - begun), begun, 1, performance=1))
    assert "where 0.4 was done" in complaint


def test_work_that_begins_in_the_middle_is_found():
    assert "where 0 was done" in progress_found(piece(0, 5, 0.5, 1))[0]


def test_work_that_is_done_anew_is_found_where_no_rule_lets_it():
    twice = piece(0, 4, 0, 0.4), piece(50, 60, 0, 1, performance=1)
    assert len(progress_found(*twice)) == 1
    for rule in ("at_break: restart", "at_end: restart"):
        assert progress_found(*twice, text=PROGRESS_FLOOR.replace("to: 14:00", f"to: 14:00, {rule}")) == []
    assert (
        progress_found(
            *twice, text=PROGRESS_FLOOR.replace("t: {fixed: 10 s}", "t: {fixed: 10 s, interruption: restart}")
        )
        == []
    )


def test_a_rule_of_one_worker_is_no_excuse_for_another():
    of_ben = piece(0, 4, 0, 0.4, worker=1), piece(50, 60, 0, 1, worker=1, performance=1)
    assert len(progress_found(*of_ben, text=PROGRESS_FLOOR.replace("to: 14:00", "to: 14:00, at_break: restart"))) == 1


def test_the_next_task_before_the_last_one_is_done_is_found():
    assert progress_found(piece(0, 10, 0, 1), piece(20, 30, 0, 1, performance=1, station=1)) == []
    assert progress_found(piece(0, 4, 0, 0.4), piece(20, 30, 0, 1, performance=1, station=1)) != []


def test_a_job_that_leaves_half_done_is_found():
    leaves = row(CREATE, 0, 0, job=0), row(FINISH, 60, 60, job=0)
    assert progress_found(piece(0, 10, 0, 1), *leaves) == []
    assert "not done" in progress_found(piece(0, 4, 0, 0.4), *leaves)[0]


def test_a_set_up_may_begin_anew():
    ups = [row(SETUP, at, at + 4, worker=0, station=0, job=0, task=0, k=at, progress=(0, 0.4)) for at in (0, 20)]
    assert progress_found(*ups) == []


def test_progress_beyond_the_whole_or_backwards_is_found():
    assert "a piece goes from 0 to 1.2" in progress_found(piece(0, 12, 0, 1.2))[0]
    assert "a piece goes from 0.5 to 0.5" in progress_found(piece(0, 12, 0.5, 0.5))[0]


def test_one_performance_goes_at_one_pace():
    (complaint,) = progress_found(piece(0, 4, 0, 0.4), piece(50, 57, 0.4, 1))
    assert "0.4 of it took 4 s of 11 s" in complaint


@pytest.mark.parametrize("rule", ["finish", "finish_job", "resume", "resume_any", "hand_over", "restart"])
def test_every_rule_of_interruption_obeys_the_law(rule):
    text = (
        PROGRESS_FLOOR.replace("horizon: 100 s", "horizon: 2 h")
        .replace("to: 14:00", f"to: 07:30, at_break: {rule}, breaks: {{a: {{at: 06:20, lasts: 7 min}}}}")
        .replace("fixed: 10 s", "dist: lognormal, mean: 100 s, cv: 0.5")
    )
    log, p = ran_of_progress(text)
    assert list(progress(log, p, Stays(log))) == []


ROOMS_FLOOR = """
opsim: 1
name: rooms
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations:
  a: {at: here, tasks: [t], buffer: 1, buffer_after: 2}
  b: {at: here, tasks: [t], buffer: 3, batch: {size: 2}}
stores: {rack: {at: here, capacity: 2}}
conveyors: {belt: {from: here, to: there, speed: 1 m/s, pitch: 2 m}}
products: {part: {route: [a, belt, b, rack]}, whole: {route: [a], parts: {a: {part: 1}}}}
sources: {parts: {kind: saturated, products: [part]}, wholes: {kind: poisson, every: 20 s, products: [whole]}}
"""
A, B, BELT, RACK = range(4)


def rooms_found(*rows):
    p = plan(ROOMS_FLOOR)
    assert [place.name for place in p.stations] == ["a", "b", "belt", "rack"]
    jobs = {r[8] for r in rows}
    log = made([*rows, *(row(CREATE, 0, 0, job=job) for job in jobs)], p)
    return list(rooms(log, p, Stays(log)))


def at(station, kind, n, cause=0):
    return [row(kind, 10, 20, station=station, job=job, cause=cause) for job in range(n)]


@pytest.mark.parametrize(
    ("rows", "most"),
    [
        (lambda n: [work(10, 20, A, job=job) for job in range(n)], 1),
        (lambda n: at(A, QUEUE, n), 1),
        (lambda n: at(A, QUEUE, n, AFTER), 2),
        (lambda n: at(A, QUEUE, n, PICKUP), 2),
        (lambda n: at(A, TRANSPORT, n), 2),
        (lambda n: at(B, HELD, n, BATCH), 2),
        (lambda n: at(B, BLOCKED, n), 2),
        (lambda n: at(BELT, TRANSPORT, n), 2),
        (lambda n: at(BELT, QUEUE, n), 2),
        (lambda n: at(RACK, QUEUE, n, STOCK), 2),
        (lambda n: at(RACK, TRANSPORT, n), 2),
    ],
)
def test_one_more_than_there_is_room_for_is_found(rows, most):
    assert rooms_found(*rows(most)) == []
    (complaint,) = rooms_found(*rows(most + 1))[:1]
    assert f"{most + 1} jobs at once on {most} " in complaint


def test_who_comes_as_another_leaves_stands_in_his_place():
    assert rooms_found(*at(A, QUEUE, 1), row(QUEUE, 20, 30, station=A, job=7)) == []


def test_kinds_of_points_are_called_by_their_names():
    assert "store rack: 3 jobs" in rooms_found(*at(RACK, QUEUE, 3, STOCK))[0]
    assert "conveyor belt: 3 jobs" in rooms_found(*at(BELT, TRANSPORT, 3))[0]


SHARED_FLOOR = """
opsim: 1
name: shared
run: {horizon: 100 s}
layout: {places: {here: [0 m, 0 m], there: [4 m, 0 m]}}
tasks: {t: {fixed: 10 s, automatic: true}}
stations:
  a:
    at: here
    tasks: [t]
    servers: 9
    needs: {gun: 1}
    breakdowns: {jam: {every: {fixed: 50 s}, repair: {fixed: 1 s}, team: men}}
  b: {like: a, at: there}
  c: {at: there, tasks: [t], servers: 9}
tools: {gun: {n: 2}, jig: {n: 1}}
repair_teams: {men: {n: 1}}
transporters: {cart: {n: 2, at: here, speed: 1 m/s, legs: [[a, b]]}}
cards: {loop: {n: 2, from: a, to: b}, round: {n: 2, from: b, to: c}}
products: {p: {route: [a, b, c]}}
release: {kind: saturated}
"""


def shared_found(*rows):
    p = plan(SHARED_FLOOR)
    log = made([*rows, *(row(CREATE, 0, 0, job=job) for job in {r[8] for r in rows if r[8] >= 0})], p)
    return list(shared(log, p, Stays(log)))


def tools(n, k=0):
    return [row(TOOL, 10, 20, station=0, job=job, k=k) for job in range(n)]


def in_loop(n):
    """Jobs at a, then at b."""
    return [r for job in range(n) for r in (work(10, 20, 0, job=job), work(20, 30, 1, job=job))]


@pytest.mark.parametrize(
    ("rows", "most", "name"),
    [
        (tools, 2, "tool gun: 3 in use"),
        (lambda n: tools(n, k=1), 1, "tool jig: 2 in use"),
        (lambda n: [row(REPAIR, 10, 20, station=s, task=s) for s in range(n)], 1, "repair team men: at 2"),
        (in_loop, 2, "loop loop: 3 jobs"),
    ],
)
def test_one_more_than_there_are_is_found(rows, most, name):
    assert [complaint for complaint in shared_found(*rows(most)) if name[:8] in complaint] == []
    assert any(complaint.startswith(name) for complaint in shared_found(*rows(most + 1)))


def test_repairs_one_after_the_other_are_right():
    assert shared_found(row(REPAIR, 10, 20, station=0, task=0), row(REPAIR, 20, 30, station=1, task=1)) == []


def test_a_card_is_given_back_on_leaving_the_end_of_its_loop():
    waits_behind = [row(QUEUE, 30, 90, station=2, job=job) for job in range(2)]
    third = work(30, 40, 0, job=2)
    assert shared_found(*in_loop(2), *waits_behind, third) == []
    too_soon = work(29, 39, 0, job=2)
    assert shared_found(*in_loop(2), *waits_behind, too_soon) == ["loop loop: 3 jobs in it at once on 2 cards"]


def vehicle(k, start, end):
    return row(TRANSPORT, start, end, places=(0, 1), k=k)


def test_a_vehicle_does_one_thing_at_a_time():
    assert shared_found(vehicle(0, 10, 20), vehicle(0, 20, 30), vehicle(1, 10, 30)) == []
    assert shared_found(vehicle(0, 10, 20), vehicle(0, 19, 30)) == ["vehicle 0 does two things at once"]


def test_a_vehicle_that_nobody_has_is_found():
    assert shared_found(vehicle(2, 10, 20)) == ["vehicle 2 drives, and there are 2"]
