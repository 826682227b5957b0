"""Who is there outside of his shifts, off within them, or at work too long after them is found."""

import pytest
from plans import plan

from opsim.laws.jobs import Stays
from opsim.log import ABSENT, BREAK, IDLE, OFF, WAIT, WALK
from opsim.subjects.shifts.laws import duty
from tests.opsim.kpi.made_logs import made, row, work

H = 3600
FLOOR = """
opsim: 1
name: duty
run: {start: Mon 06:00, horizon: 6 h}
layout: {places: {here: [0 m, 0 m], there: [30 m, 0 m]}}
shifts: {hour: {from: 07:00, to: 09:00, breaks: {tea: {at: 08:00, lasts: 10 min}}}}
tasks: {t: {dist: exponential, mean: 10 s}}
stations: {a: {at: here, tasks: [t], buffer: 3}}
products: {p: {route: [a]}}
release: {kind: poisson, every: 10 s}
workers: {ana: {shift: hour, skills: {a: 1.0}}, ben: {skills: {a: 1.0}}}
"""


def found(*rows, rule="finish", overtime="", at_break="finish", place=""):
    text = FLOOR.replace("to: 09:00", f"to: 09:00, at_end: {rule}, at_break: {at_break}{overtime}")
    p = plan(text.replace("lasts: 10 min", f"lasts: 10 min, place: {place}") if place else text)
    log = made(rows, p)
    return list(duty(log, p, Stays(log)))


def off(begin, end):
    return row(OFF, begin, end, worker=0)


def at_work(begin, end, *, job=0, performance=0, progress=(0, 1)):
    return work(begin, end, 0, job=job, worker=0, k=performance, progress=progress)


DAY = [off(0, H), row(WAIT, H, 2 * H, worker=0), row(BREAK, 2 * H, 2 * H + 600, worker=0)]
OVER = off(3 * H, 6 * H)
REST = row(WAIT, 2 * H + 600, 3 * H - 60, worker=0)


def test_a_day_as_it_was_planned_is_right():
    assert found(*DAY, row(WAIT, 2 * H + 600, 3 * H, worker=0), off(3 * H, 6 * H)) == []


def test_who_comes_before_his_shift_is_found():
    assert "comes at 3000 s" in found(off(0, 3000), row(WAIT, 3000, 3 * H, worker=0), off(3 * H, 6 * H))[0]


def test_who_goes_before_its_end_is_found():
    assert "off at 10000 s, in his shift" in found(off(0, H), row(WAIT, H, 10000, worker=0), off(10000, 6 * H))[0]


def test_a_break_that_is_never_taken_is_found():
    assert (
        "tea is due at 7200 s, and he is free at 7200 s"
        in found(off(0, H), row(WAIT, H, 3 * H, worker=0, cause=IDLE), OVER)[0]
    )
    works = at_work(H, 2 * H - 1), at_work(2 * H - 1, 2 * H + 9, performance=1, job=1)
    busy = off(0, H), *works, at_work(2 * H + 9, 3 * H, performance=2, job=2), OVER
    assert "tea is due at 7200 s, and he is still at work at 7209 s" in found(*busy)[0]


@pytest.mark.parametrize("rule, right", [("finish", True), ("hand_over", True), ("resume", False), ("restart", False)])
def test_a_break_begins_late_only_after_what_the_rule_lets_him_finish(rule, right):
    late = row(BREAK, 2 * H + 60, 2 * H + 660, worker=0), row(WAIT, 2 * H + 660, 3 * H, worker=0), OVER
    begun = off(0, H), row(WAIT, H, 2 * H - 60, worker=0), at_work(2 * H - 60, 2 * H + 60)
    complaints = found(*begun, *late, at_break=rule)
    assert (complaints == []) is right
    assert right or "still at work at 7200 s" in complaints[0]


def test_a_break_that_is_shorter_than_planned_is_found():
    short = row(BREAK, 2 * H, 2 * H + 599, worker=0), row(WAIT, 2 * H + 599, 3 * H, worker=0)
    assert "tea lasts from 7200 s to 7799 s, planned is until 7800 s" in found(*DAY[:2], *short, OVER)[0]


def test_the_end_of_the_shift_cuts_a_break_that_began_late():
    begun = off(0, H), row(WAIT, H, 2 * H - 60, worker=0), at_work(2 * H - 60, 3 * H - 60)
    assert found(*begun, row(BREAK, 3 * H - 60, 3 * H, worker=0), OVER) == []
    assert "tea lasts from" in found(*begun, row(BREAK, 3 * H - 60, 3 * H - 1, worker=0), OVER)[0]
    assert found(*begun[:2], at_work(2 * H - 60, 3 * H), OVER) == []  # it is lost where he is done so late


def test_the_way_to_the_place_of_a_break_is_part_of_it():
    way = row(WALK, 2 * H, 2 * H + 30, worker=0, places=(0, 1))
    rest = row(WAIT, 2 * H + 600, 3 * H, worker=0), OVER
    assert found(*DAY[:2], way, row(BREAK, 2 * H + 30, 2 * H + 600, worker=0), *rest, place="there") == []
    long = row(BREAK, 2 * H + 30, 2 * H + 630, worker=0), row(WAIT, 2 * H + 630, 3 * H, worker=0), OVER
    assert "tea lasts from 7200 s" in found(*DAY[:2], way, *long, place="there")[0]
    assert "he is free at 7200 s" in found(*DAY[:2], way, *long, place="here")[0]


def test_a_break_that_is_longer_than_planned_is_found():
    long = row(BREAK, 2 * H, 2 * H + 601, worker=0)
    assert "planned are 600 s" in found(*DAY[:2], long, row(WAIT, 2 * H + 601, 3 * H, worker=0), off(3 * H, 6 * H))[0]


@pytest.mark.parametrize("rule, right", [("finish", True), ("hand_over", True), ("resume", False), ("restart", False)])
def test_a_task_under_way_is_finished_only_where_the_rule_says_so(rule, right):
    late = found(*DAY, REST, at_work(3 * H - 60, 3 * H + 30), off(3 * H + 30, 6 * H), rule=rule)
    assert (late == []) is right
    assert right or "still at work at 10800 s" in late[0]


@pytest.mark.parametrize("rule, right", [("finish", False), ("finish_job", True)])
def test_the_next_task_of_the_job_is_begun_only_under_finish_job(rule, right):
    tasks = at_work(3 * H - 60, 3 * H + 30), at_work(3 * H + 30, 3 * H + 90, performance=1)
    assert (found(*DAY, REST, *tasks, off(3 * H + 90, 6 * H), rule=rule) == []) is right


def test_another_job_is_not_begun_after_the_end():
    tasks = at_work(3 * H - 60, 3 * H + 30), at_work(3 * H + 30, 3 * H + 90, performance=1, job=1)
    assert len(found(*DAY, REST, *tasks, off(3 * H + 90, 6 * H), rule="finish_job")) == 1


def test_overtime_is_work_until_its_own_end():
    later = *DAY, REST, at_work(3 * H - 60, 3 * H), at_work(3 * H, 4 * H, job=1, performance=1)
    assert found(*later, off(4 * H, 6 * H), overtime=", overtime: {most: 1 h}") == []
    assert len(found(*later, off(4 * H, 6 * H), overtime=", overtime: {most: 59 min}", rule="resume")) == 1
    assert len(found(*later, off(4 * H, 6 * H))) == 1


def test_a_shift_is_missed_whole_or_not_at_all():
    assert found(off(0, H), row(ABSENT, H, 3 * H, worker=0), off(3 * H, 6 * H)) == []
    half = off(0, H), row(ABSENT, H, 2 * H, worker=0), row(WAIT, 2 * H, 3 * H, worker=0), off(3 * H, 6 * H)
    assert "which is no shift of his" in found(*half)[0]


def test_who_has_no_shift_is_never_late():
    assert found(off(0, H), row(WAIT, H, 3 * H, worker=0), off(3 * H, 6 * H), work(0, 6 * H, 0, worker=1)) == []
