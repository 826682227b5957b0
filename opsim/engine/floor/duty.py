"""Shifts, breaks, meetings, absence: when people come and when they have to go, by their calendars."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor import attendance, leaving, overtime, relief, ties
from opsim.engine.floor.attendance import be_here, leave
from opsim.engine.floor.machine import cast, inlined, line_of, step
from opsim.engine.floor.parts.bits import leave_none
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.luck import ABSENCE, number_at, stream_of
from opsim.engine.floor.parts.moments import BEGIN, GONE, HERE, LEAVING, PAUSE, PAUSED
from opsim.engine.floor.parts.people import People
from opsim.engine.floor.parts.presence import Duty, Moment, Presence
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.rows import log_worker
from opsim.engine.floor.parts.state import DUTY, Floor, Worker
from opsim.engine.floor.pauses import end_pause
from opsim.engine.floor.presence import presence_of
from opsim.engine.floor.ties import release
from opsim.engine.floor.worker import set_free, take_off
from opsim.engine.rules import CALENDAR
from opsim.engine.rules.duty import is_absent
from opsim.log import ABSENT, OFF

_is_absent = inlined(is_absent)
_as_presence, _as_duty = cast(Presence), cast(Duty)


@step
def open_calendars(floor: Floor, people: People) -> bool:
    """Nobody who has shifts is there before the first of them begins."""
    for i in range(people.n):
        one = people.those[i]
        take_off(floor, one.worker, OFF, 0)
        turn(floor, one)
    return True


@step
def turns(floor: Floor, event: Event) -> None:
    """Something of somebody's calendar is due."""
    turn(floor, _as_presence(event.subject))


@step
def turn(floor: Floor, one: Presence) -> None:
    """Apply what is due of somebody's calendar, and wait for the next of it."""
    while one.next < one.n_moments:
        due = one.moments[one.next]
        if due.at_s > floor.now:
            rank = floor.n_stations + floor.n_sources + one.worker.rank
            alarm(floor, due.at_s - floor.now, CALENDAR, rank, 0, line_of_turns, one)
            return
        if due.what == BEGIN:
            _begin(floor, one, due.duty)
        elif due.what == PAUSE:
            _owe(floor, one, due)
        else:
            _end(floor, one, due)
        one.next += 1


@step
def _begin(floor: Floor, one: Presence, duty: Duty) -> None:
    """His shift begins. Who is still there from the one before goes on, and is not absent; unless he goes since he
    misses this one, which has followed at once.
    """
    if one.misses and one.state == LEAVING:
        return
    worker = one.worker
    one.duty, one.overtime, one.undecided = duty, 0, 0
    if one.state == GONE and _misses(floor, one, duty):
        _be_away(floor, worker, ABSENT)
        release(floor, worker)
    elif one.state == GONE:
        set_free(floor, worker)
        worker.place, worker.round = worker.home, -1
        be_here(floor, one)
    elif one.state == LEAVING:
        be_here(floor, one)


@step
def _end(floor: Floor, one: Presence, due: Moment) -> None:
    """His shift is over. Where another one follows at once, he goes only if he misses that."""
    worker, follows = one.worker, False
    one.owed.clear()
    missed = one.misses
    one.misses = 0
    if due.follows:
        follows = True
        one.misses = _misses(floor, one, due.follows)
    if one.state == GONE:
        _be_away(floor, worker, OFF)
    elif follows and not one.misses:
        if one.state == LEAVING:
            be_here(floor, one)
    elif not missed:
        if one.state == PAUSED:
            end_pause(floor, one)
        be_here(floor, one)
        most_s = due.duty.overtime_s
        if most_s > 0:  # whether he stays is seen when all who come at this instant are there
            one.overtime = one.undecided = 1
            leave_none(floor, worker, DUTY)
            rank = floor.n_stations + floor.n_sources + worker.rank
            event = alarm(floor, most_s, CALENDAR, rank, 2, line_of_overtime_over, one)
            event.other = due.duty
        else:
            leave(floor, one, True)


@step
def _owe(floor: Floor, one: Presence, due: Moment) -> None:
    """A pause begins: at once, or after the one before, or when he is done."""
    if one.state == GONE or one.duty is not due.duty:
        return
    one.owed.append(due.pause)
    if one.state == HERE:
        leave(floor, one, False)


@step
def _misses(floor: Floor, one: Presence, duty: Duty) -> bool:
    share = one.worker.absence
    if share <= 0:
        return False
    if not one.chances:
        one.chances = stream_of(floor, ABSENCE, one.worker.rank, 0, 0)
    return _is_absent(number_at(floor, one.chances, duty.number), share)


@inlined
def _be_away(floor: Floor, worker: Worker, kind: int) -> None:
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = kind, 0, floor.now


@step
def overtime_over(floor: Floor, event: Event) -> None:
    """He goes, however much there is still to do."""
    one: Presence = _as_presence(event.subject)
    if one.overtime and one.duty is _as_duty(event.other):
        leave(floor, one, True)


line_of_turns, line_of_overtime_over = line_of(turns), line_of(overtime_over)


def install(build: Any) -> None:
    """The calendars of people, where somebody has one; after the blocks that set people free."""
    if all(worker.duties is None for worker in build.plan.workers):
        return
    people = build.floor.people = build.arena.new("People")
    those = [presence_of(build, worker) for worker in build.workers if _has_shifts(build, worker)]
    people.n, people.those = len(those), build.arena.array("Presence", those)
    ties.hang(build)
    relief.hang(build, people)
    overtime.set_needs(build, people)
    leaving.set_lines(build, people)
    attendance.hang(build, people)
    build.line(turns), build.line(overtime_over)
    build.hang(build.floor.starts, open_calendars, people)


def _has_shifts(build: Any, worker: Any) -> bool:
    return build.plan.workers[worker.rank].duties is not None
