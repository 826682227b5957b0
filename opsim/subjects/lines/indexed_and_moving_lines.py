"""Paced lines of two kinds: on an indexed line all jobs move by one station at the same instant; on a moving line they
ride all the time, past stations that are stretches of it.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import leave_server, move_on
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import NOTHING, drop, inlined, line_of, step
from opsim.engine.floor.state import Job, Station
from opsim.log import FULL, HELD, LINE_STOP, NO_CAUSE, QUEUE, TAKT, UNFINISHED
from opsim.subjects.lines.andon import call_for, hang_andon, nobody_wanted, send_on
from opsim.subjects.lines.line_walks import hang_walks, line_changed, stop_walks
from opsim.subjects.lines.paced_lines import (
    AT_THE_END,
    TICK,
    Due,
    Line,
    clock_s,
    is_open_at,
    opens,
    paced_line,
    set_clock,
    shut_but_when_it_moves,
)
from opsim.subjects.lines.plan import LinePlan
from opsim.subjects.stations.station import seat


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


@step
def move_moving(floor: Floor, line: Line) -> int:
    """A takt is over: the next job may come."""
    opens(floor, line)
    line.changed = 1
    return NO_CAUSE


@step
def receive(floor: Floor, station: Station, job: Job) -> None:
    """The job is done at the station before, or comes onto the line: it rides until its worker may begin."""
    line, at, block = station.line, station.line_at, job.block
    now_s = clock_s(line, floor.now)
    if not block.on_line:
        block.on_line, block.line_began_s = 1, now_s
    began_s = block.line_began_s
    block.line_open = at + 1
    set_clock(floor, line, began_s + line.limit_s[at], station.rank, job.number, line_of_limit, job, at)
    if line.andon:
        call_s = max(began_s + line.start_s[at] + line.call_s, now_s)
        if call_s > now_s:
            set_clock(floor, line, call_s, station.rank, job.number, moving_line_of_call, job, at)
        else:
            call_for(floor, line.andon, job)
    reach_s = began_s + line.reach_s[at]
    if reach_s > now_s:
        job_now(floor, job, QUEUE, TAKT)
        set_clock(floor, line, reach_s, station.rank, job.number, line_of_reach, job, at)
    else:
        _begins(floor, job)


@inlined
def _begins(floor: Floor, job: Job) -> None:
    station = job.station
    job_now(floor, job, QUEUE, 0)
    if station.free_servers:
        seat(floor, station, job)
    else:
        station.queue.append(job)


@step
def in_reach(floor: Floor, due: Due) -> None:
    """The job is where its worker may begin: on a server where one is free."""
    _begins(floor, due.job)


@step
def at_limit(floor: Floor, due: Due) -> None:
    """The job is where its worker must stop."""
    line, job = due.line, due.job
    if not is_open_at(line, job, due.at):
        return
    if line.sends_on:
        stop_walks(floor, line, job, -1)
        if send_on(floor, job):
            return
    if not job.block.line_late:
        job.block.line_late = 1
        line.n_late += 1


@step
def call_for_open(floor: Floor, due: Due) -> None:
    """Somebody is wanted at a job that is not done."""
    if is_open_at(due.line, due.job, due.at):
        call_for(floor, due.line.andon, due.job)


@step
def rides_on(floor: Floor, line: Line, job: Job) -> bool:
    """On to the next station; from the last one the job rides to the end of the line, off its server."""
    job.block.line_open = 0
    _is_late_no_more(line, job)
    _nobody_comes(floor, line, job)
    station = job.station
    if station.line_at != line.n_stations - 1:
        return True
    exit_s = job.block.line_began_s + line.exit_s
    if exit_s <= clock_s(line, floor.now):
        _ends(line, job)
        return True
    job_now(floor, job, QUEUE, TAKT)
    if job in station.seated:
        leave_server(floor, station, job)
    set_clock(floor, line, exit_s, station.rank, job.number, line_of_end, job, 0)
    return False


@step
def at_the_end(floor: Floor, due: Due) -> None:
    """The job is at the end of the line."""
    _ends(due.line, due.job)
    move_on(floor, due.job)


line_of_limit, moving_line_of_call, line_of_reach = line_of(at_limit), line_of(call_for_open), line_of(in_reach)
line_of_end = line_of(at_the_end)


@inlined
def _ends(line: Line, job: Job) -> None:
    if not job.block.line_ending:
        job.block.line_ending = 1
        line.n_ending += 1


@inlined
def _is_late_no_more(line: Line, job: Job) -> None:
    if job.block.line_late:
        job.block.line_late = 0
        line.n_late -= 1


@inlined
def _nobody_comes(floor: Floor, line: Line, job: Job) -> None:
    stop_walks(floor, line, job, -1)
    if line.andon:
        nobody_wanted(floor, line.andon, job)


@step
def left_moving(floor: Floor, line: Line, job: Job, station: Station) -> None:
    """A job has left its station, of the line or another."""
    if station.line is line:
        _nobody_comes(floor, line, job)
        if station.line_at == line.n_stations - 1:
            _forget(line, job)


@step
def left_floor(floor: Floor, line: Line, job: Job) -> None:
    """A job that was on the line is on the floor no more."""
    if job.block.on_line and job.station.line is line:
        _forget(line, job)


@inlined
def _forget(line: Line, job: Job) -> None:
    """The job is on the line no more."""
    job.block.on_line = job.block.line_open = 0
    _is_late_no_more(line, job)
    if job.block.line_ending:
        job.block.line_ending = 0
        line.n_ending -= 1


@step
def vacate(floor: Floor, station: Station, job: Job) -> None:
    """A job goes on, and gives its server back where it has one still."""
    if job in station.seated:
        leave_server(floor, station, job)


@step
def clear_end(floor: Floor, station: Station, job: Job) -> None:
    """A job at the end of the line that cannot leave it is off its server."""
    job_now(floor, job, QUEUE, LINE_STOP)
    if job in station.seated:
        leave_server(floor, station, job)


def moving_line(build: Any, plan: LinePlan) -> None:
    """Hang a moving line in."""
    line, n = paced_line(build, plan), len(plan.stations)
    line.start_m, line.start_s = build.floats(plan.start_m), build.floats(plan.start_s(at) for at in range(n))
    line.reach_s, line.reach_m = build.floats(plan.reach_s), build.floats(plan.reach_m(at) for at in range(n))
    line.limit_s = build.floats(plan.limit_s)
    line.move_line, line.stood_line = build.line(move_moving), build.line(line_changed)
    hang_walks(build, plan, line)
    if plan.floaters:
        line.andon = hang_andon(build, plan, line)
    for rank in plan.stations:
        station = build.stations[rank]
        station.receive, station.vacate = build.hook(receive), build.hook(vacate)
        build.hang(station.afters, rides_on, line, AT_THE_END)
    build.stations[plan.stations[-1]].clear = build.hook(clear_end)
    build.hang(build.floor.left_station, left_moving, line)
    build.hang(build.floor.left_floor, left_floor, line)


def install(build: Any) -> None:
    """A line that moves jobs at intervals, or all the time, for each that the plan has."""
    if not build.plan.lines:
        return

    build.keep_jobs()
    for plan in build.plan.lines:
        (moving_line if plan.moves else indexed_line)(build, plan)
