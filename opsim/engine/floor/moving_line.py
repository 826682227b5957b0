"""Moving lines: jobs ride on a line that moves all the time, past stations that are stretches of it."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.andon import call_for, hang_andon, nobody_wanted
from opsim.engine.floor.line_clock import set_clock
from opsim.engine.floor.line_walks import hang_walks, line_changed, stop_walks
from opsim.engine.floor.machine import inlined, line_of, step
from opsim.engine.floor.material import leave_server, move_on
from opsim.engine.floor.paced_line import opens, paced_line
from opsim.engine.floor.parts.line_clocks import clock_s, is_open_at
from opsim.engine.floor.parts.lines import AT_THE_END, Due, Line
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Job, Station
from opsim.engine.floor.sent_on import send_on
from opsim.engine.floor.station import seat
from opsim.log import LINE_STOP, NO_CAUSE, QUEUE, TAKT
from opsim.plan import LinePlan


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
            set_clock(floor, line, call_s, station.rank, job.number, line_of_call, job, at)
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


line_of_limit, line_of_call, line_of_reach = line_of(at_limit), line_of(call_for_open), line_of(in_reach)
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
