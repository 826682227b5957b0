"""Indexed lines: all jobs move by one station at the same instant."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine.andon import call_for, hang_andon, nobody_wanted
from opsim.engine.fast_engine.line_clock import set_clock
from opsim.engine.fast_engine.machine import NOTHING, clear, drop, has, inlined, line_of, push, step
from opsim.engine.fast_engine.material import move_on
from opsim.engine.fast_engine.paced_line import opens, paced_line, shut_but_when_it_moves
from opsim.engine.fast_engine.parts.line_clocks import clock_s
from opsim.engine.fast_engine.parts.lines import Due, Line
from opsim.engine.fast_engine.parts.rows import job_now
from opsim.engine.fast_engine.parts.state import Floor, Job, Station
from opsim.engine.fast_engine.sent_on import send_on
from opsim.engine.simpy_engine.paced_line import AT_THE_END, TICK
from opsim.log import FULL, HELD, LINE_STOP, NO_CAUSE, TAKT, UNFINISHED
from opsim.plan import LinePlan


@step
def move_indexed(floor: Floor, line: Line) -> int:
    """A takt is over: all jobs move on by one station, the last one first, where they are done and it can leave.

    Why they cannot, NO_CAUSE: they did.
    """
    _find_late(floor, line)
    if line.sends_on:
        for i in range(len(line.late)):
            if send_on(floor, line.late[i]):
                line.changed = 1
        _find_late(floor, line)
    if len(line.late):
        return UNFINISHED
    last = line.stations[line.n_stations - 1]
    if len(last.seated) and not line.leaving:
        line.leaving = line.changed = 1
        drop(line.done, last.seated[0])
        move_on(floor, last.seated[0])
    if len(last.seated):
        return FULL
    _index(floor, line)
    line.changed = 1
    return NO_CAUSE


@inlined
def _find_late(floor: Floor, line: Line) -> None:
    """The jobs on the line that are not done, from its beginning."""
    clear(line.late)
    for at in range(line.n_stations):
        station = line.stations[at]
        leaves = line.leaving and at == line.n_stations - 1
        for i in range(len(station.seated)):
            if not leaves and not has(line.done, station.seated[i]):
                push(floor, line.late, station.seated[i])


@inlined
def _index(floor: Floor, line: Line) -> None:
    line.leaving = 0
    clear(line.done)
    opens(floor, line)
    for at in range(line.n_stations - 2, -1, -1):
        if len(line.stations[at].seated):
            move_on(floor, line.stations[at].seated[0])
    if line.andon:
        call_s = clock_s(line, floor.now) + line.call_s
        set_clock(floor, line, call_s, line.stations[0].rank, TICK, line_of_call, NOTHING, 0)


@step
def call_for_late(floor: Floor, due: Due) -> None:
    """Somebody is wanted at all jobs that are not done."""
    line = due.line
    for at in range(line.n_stations):
        station = line.stations[at]
        for i in range(len(station.seated)):
            if not has(line.done, station.seated[i]):
                call_for(floor, line.andon, station.seated[i])


line_of_call = line_of(call_for_late)


@step
def indexed_stood(floor: Floor, line: Line) -> None:
    """Jobs that wait for the move wait for the line to run."""
    for at in range(line.n_stations):
        station = line.stations[at]
        for i in range(len(station.seated)):
            if has(line.done, station.seated[i]):
                job_now(floor, station.seated[i], HELD, TAKT if line.why == NO_CAUSE else LINE_STOP)


@step
def waits_for_move(floor: Floor, line: Line, job: Job) -> bool:
    """The job is done, and stays on its server until the line moves."""
    if not has(line.done, job):
        push(floor, line.done, job)
    job_now(floor, job, HELD, TAKT if line.why == NO_CAUSE else LINE_STOP)
    if line.andon:
        nobody_wanted(floor, line.andon, job)
    return False


@step
def left_indexed(floor: Floor, line: Line, job: Job, station: Station) -> None:
    """A job that was scrapped is waited for by nobody."""
    if line.andon and station.line is line:
        nobody_wanted(floor, line.andon, job)


def indexed_line(build: Any, plan: LinePlan) -> None:
    """Hang an indexed line in."""
    line = paced_line(build, plan)
    line.move_line, line.stood_line = build.line(move_indexed), build.line(indexed_stood)
    if plan.floaters:
        line.andon = hang_andon(build, plan, line)
    for rank in plan.stations:
        build.hang(build.stations[rank].afters, waits_for_move, line, AT_THE_END)
    build.hang(build.floor.left_station, left_indexed, line)
    for rank in plan.stations[1:]:
        shut_but_when_it_moves(build, line, rank)
