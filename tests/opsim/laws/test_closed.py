"""Work that begins at a closed station is found, and rows that close it in other hours than its calendar."""

import pytest
from plans import plan

from opsim.laws.hours import closed
from opsim.laws.jobs import Stays
from opsim.log import CLOSED, HELD, IS_DOWN, OFF, REPAIR, SETUP
from tests.opsim.kpi.made_logs import made, row, work

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


def found(*rows, text=FLOOR, shut=SHUT):
    p = plan(text)
    log = made([*shut, *rows], p)
    return list(closed(log, p, Stays(log)))


@pytest.mark.parametrize("begin, end", [(3600, 7200), (5000, 5100)])
def test_work_in_open_hours_is_right(begin, end):
    assert found(work(begin, end, 0)) == found(work(begin, end, 0), text=RESUME) == []


def test_what_was_begun_may_be_finished_where_the_rule_says_so():
    assert found(work(7000, 7300, 0)) == []
    assert "work goes on at 7200 s" in found(work(7000, 7300, 0), text=RESUME)[0]


@pytest.mark.parametrize("begin, end", [(0, 10), (3599, 3700), (7200, 7300), (9000, 9100)])
def test_work_that_begins_while_it_is_closed_is_found(begin, end):
    (complaint,) = found(work(begin, end, 0))
    assert complaint.startswith("station a: work goes on at")


def test_what_is_handed_over_after_closing_goes_on():
    pieces = work(7000, 7300, 0, progress=(0, 0.5)), work(7300, 7400, 0, k=1, progress=(0.5, 1))
    assert found(*pieces) == []
    assert len(found(pieces[0], work(7301, 7400, 0, k=1, progress=(0.5, 1)))) == 1


def test_what_was_broken_off_before_may_be_gone_on_with_in_the_instant_of_closing():
    pieces = work(7000, 7100, 0, progress=(0, 0.5)), work(7200, 7300, 0, k=1, progress=(0.5, 1))
    assert found(*pieces) == []


HALF = work(7000, 7300, 0, progress=(0, 0.5))


def shut_in(begin, end, cause=CLOSED):
    return row(HELD, begin, end, station=0, job=0, cause=cause)


def test_what_was_begun_and_is_left_undone_since_the_station_is_closed_is_found():
    (complaint,) = found(HALF, shut_in(7300, 10800))
    assert complaint == "station a: job 0 is left undone at 7300 s, though what was begun is finished there"
    assert found(HALF, shut_in(7200, 10800), text=RESUME) != []  # the law of resume is another one
    assert "left undone" not in "".join(found(HALF, shut_in(7300, 10800), text=RESUME))


def test_what_a_stop_of_the_station_breaks_off_may_wait_for_the_opening():
    stop = row(REPAIR, 7300, 7400, station=0)
    assert found(HALF, shut_in(7300, 10800), stop) == []
    assert found(HALF, shut_in(7300, 7400, IS_DOWN), shut_in(7400, 10800)) == []


def test_what_is_done_waits_for_its_next_task_until_the_opening():
    assert found(work(7000, 7300, 0), shut_in(7300, 10800)) == []


@pytest.mark.parametrize("leaves, complaints", [("08:01:40", 0), ("08:01:41", 1)])
def test_who_has_to_go_may_leave_it_undone(leaves, complaints):
    text = FLOOR.replace(", automatic: true", "").replace(
        "hour: {from: 07", f"ana: {{from: 06:00, to: {leaves}}}, hour: {{from: 07"
    )
    text += "workers: {ana: {shift: ana, skills: {a: 1, b: 1}}}"
    rows = work(7000, 7300, 0, worker=0, progress=(0, 0.5)), shut_in(7300, 10800)
    assert len(found(*rows, text=text)) == complaints


def test_a_set_up_is_work():
    assert len(found(row(SETUP, 9000, 9100, station=0, job=0, progress=(0, 1)))) == 1


def test_another_station_goes_on_all_the_time():
    assert found(work(0, 10000, 1)) == []


def test_rows_of_other_hours_than_the_calendars_are_found():
    assert "its calendar for 2 h" in found(shut=SHUT[:1])[0]
    assert "though it is always open" in found(shut=[*SHUT, row(OFF, 0, 9, station=1)])[0]
