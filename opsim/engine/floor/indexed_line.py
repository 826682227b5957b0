"""Indexed lines: all jobs move by one station at the same instant."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.andon import call_for, hang_andon, nobody_wanted
from opsim.engine.floor.line_clock import set_clock
from opsim.engine.floor.machine import NOTHING, drop, inlined, line_of, step
from opsim.engine.floor.material import move_on
from opsim.engine.floor.paced_line import opens, paced_line, shut_but_when_it_moves
from opsim.engine.floor.parts.line_clocks import clock_s
from opsim.engine.floor.parts.lines import AT_THE_END, TICK, Due, Line
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Job, Station
from opsim.engine.floor.sent_on import send_on
from opsim.log import FULL, HELD, LINE_STOP, NO_CAUSE, TAKT, UNFINISHED
from opsim.plan import LinePlan


@step
def move_indexed(floor: Floor, line: Line) -> int:
    """A takt is over: all jobs move on by one station, the last one first, where they are done and it can leave.

    Why they cannot, NO_CAUSE: they did.
    """
    _find_late(floor, line)
    if line.sends_on:
        for one in line.late:
            if send_on(floor, one):
                line.changed = 1
        _find_late(floor, line)
    if line.late:
        return UNFINISHED
    last = line.stations[line.n_stations - 1]
    if last.seated and not line.leaving:
        line.leaving = line.changed = 1
        drop(line.done, last.seated[0])
        move_on(floor, last.seated[0])
    if last.seated:
        return FULL
    _index(floor, line)
    line.changed = 1
    return NO_CAUSE


@inlined
def _find_late(floor: Floor, line: Line) -> None:
    """The jobs on the line that are not done, from its beginning."""
    line.late.clear()
    for at in range(line.n_stations):
        station = line.stations[at]
        leaves = line.leaving and at == line.n_stations - 1
        for job in station.seated:
            if not leaves and job not in line.done:
                line.late.append(job)


@inlined
def _index(floor: Floor, line: Line) -> None:
    line.leaving = 0
    line.done.clear()
    opens(floor, line)
    for at in range(line.n_stations - 2, -1, -1):
        if line.stations[at].seated:
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
        for job in station.seated:
            if job not in line.done:
                call_for(floor, line.andon, job)


line_of_call = line_of(call_for_late)


@step
def indexed_stood(floor: Floor, line: Line) -> None:
    """Jobs that wait for the move wait for the line to run."""
    for at in range(line.n_stations):
        station = line.stations[at]
        for job in station.seated:
            if job in line.done:
                job_now(floor, job, HELD, TAKT if line.why == NO_CAUSE else LINE_STOP)


@step
def waits_for_move(floor: Floor, line: Line, job: Job) -> bool:
    """The job is done, and stays on its server until the line moves."""
    if job not in line.done:
        line.done.append(job)
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
