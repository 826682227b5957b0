"""Tools: of a station for as long as a job is there, of a task for as long as somebody is at it.

Who works, and with what in his hands: tools, holds, teams and attended runs, where tasks ask for them.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.keys import is_better, keep_best, pair_key
from opsim.engine.floor.machine import Array, Call, fresh, give_back, inlined, line_of, step
from opsim.engine.floor.records import Task
from opsim.engine.floor.state import Job, Station, Worker
from opsim.subjects.people import teams
from opsim.subjects.people.teams import call_team, come_to_team, done_in_team
from opsim.subjects.people.worker import attend, may_serve, on_round
from opsim.subjects.stations.station import next_task, proceed
from opsim.subjects.tools import tool_holds
from opsim.subjects.tools.tool_grips import Want, grip_at, is_known
from opsim.subjects.tools.tool_holds import act_with_hold, acted_with_hold
from opsim.subjects.tools.tool_store import (
    AT_STATION,
    IN_HAND,
    before,
    break_off,
    call_off_tools,
    call_with,
    close_crib,
    give_out,
    leave,
    pass_on,
    put_back_tasks,
    sent,
    take,
)

STAGE = 30
"""Among the preparations of a seated job."""
PATROL = 2
"""Of ``build.WHEN_IDLE``."""
_new_want, _forget_want = fresh(Want), give_back(Want)


def install_tools(build: Any) -> bool:
    """The crib where there are tools, asked wherever a station needs some; whether there are any."""
    plan, floor = build.plan, build.floor
    if not plan.tools:
        return False
    build.keep_jobs()
    crib = floor.crib = build.arena.new("Crib")
    crib.free = build.ints(tool.n for tool in plan.tools)
    crib.shared, crib.returned = (build.ints([0] * len(plan.tools)) for _ in range(2))
    for call in (proceed_with, next_with):
        build.line(call)
    floor.tools_line = build.line(who_waits_longest)
    build.hang(floor.dispatchers, give_out)
    build.hang(floor.left_station, left_station)
    build.hang(floor.lost_server, leave)
    build.hang(floor.broken_off, break_off)
    build.hang(floor.call_off, call_off_tools)
    build.hang(floor.closing, close_crib)
    for station, at in zip(build.stations, plan.stations):
        if at.needs:
            needs = build.arena.new("Want")
            needs.n_needs, needs.needs = len(at.needs), build.ints(number for need in at.needs for number in need)
            build.hang(station.stages, for_station, needs, STAGE)
            build.seat(station)
    return True


@inlined
def _wanted(floor: Floor, job: Job, purpose: int, n_needs: int, needs: Array[int], task: int, go_on_line: Call) -> Want:
    """Tools that are the job's as soon as they are free."""
    want: Want = _new_want(floor)
    want.job, want.purpose, want.n_needs, want.needs = job, purpose, n_needs, needs
    want.task, want.go_on_line, want.at_once = task, go_on_line, 1
    return want


@step
def for_station(floor: Floor, needs: Want, job: Job) -> bool:
    """The tools that stay with the job until it leaves its station; with a batch, until the last of it does."""
    if grip_at(job, AT_STATION) >= 0:
        return True
    want = _wanted(floor, job, AT_STATION, needs.n_needs, needs.needs, -1, line_of_proceed)
    taken = take(floor, job, want)
    if taken:
        _forget_want(floor, want)
    return taken


@step
def proceed_with(floor: Floor, want: Want) -> None:
    """The tools of the station are there."""
    proceed(floor, want.job, floor.no_worker)


@step
def next_with(floor: Floor, want: Want) -> None:
    """The tools of a task are there."""
    next_task(floor, want.job, floor.no_worker)


@step
def left_station(floor: Floor, subject: Any, job: Job, station: Station) -> None:
    """What the station needs goes on to another one of the job's batch that is there yet; the rest is given back."""
    if not is_known(job):
        return
    if job.seat and grip_at(job, AT_STATION) >= 0:
        for one in station.seated:
            if one is not job and one.seat is job.seat:
                pass_on(floor, job, one)
                break
    leave(floor, subject, job, station)


@step
def for_task(floor: Floor, job: Job) -> bool:
    """Whether the tools of the task a job has come to are there; those of the one it is done with are given back.

    An automatic run takes them at once, a worker when he sets out, a team when all of it does.
    """
    position = job.task_position
    put_back_tasks(floor, job, position)
    task = floor.tasks[job.station.tasks[position]]
    if not task.n_needs or grip_at(job, position) >= 0:
        return True
    want = _wanted(floor, job, position, task.n_needs, task.needs, task.rank, line_of_next)
    want.at_once = task.automatic
    if not take(floor, job, want):
        return False
    if not task.automatic and task.team == 1:
        call_with(floor, job, want)
    else:
        _forget_want(floor, want)
    return True


@step
def at_hand(floor: Floor, job: Job) -> None:
    """A worker is there: the tools he did not bring, since he was at hand, he takes now."""
    if job.with_tools:
        sent(floor, job.station, job)


@step
def tasks_done(floor: Floor, subject: Any, job: Job) -> bool:
    """All tasks are done: their tools are given back before anything becomes of the job."""
    put_back_tasks(floor, job, IN_HAND)
    return True


@step
def who_waits_longest(floor: Floor, station: Station, job: Job) -> None:
    """The pair that was found, or that of who has waited longer for the same tools, where somebody is free for him too
    (``allocation._who_waits_longest``).
    """
    before(floor, job)
    found = floor.crib.found
    for one in found:
        if _somebody_for(floor, one.job.station):
            return


@step
def _somebody_for(floor: Floor, station: Station) -> bool:
    """Whether somebody who is free may be sent to a station: he is ``floor.found_worker`` then."""
    first, n_able = station.calling[0], 0
    for worker in floor.free:
        if not may_serve(worker, station) or (floor.idle == PATROL and not on_round(worker, station)):
            continue
        n_able += 1
        pair_key(floor, worker, station, first.job, len(station.calling) + len(station.queue), first.since_s)
        if n_able == 1 or is_better(floor):
            floor.found_worker, floor.found_station = worker, station
            keep_best(floor)
    return n_able > 0


line_of_proceed, line_of_next = line_of(proceed_with), line_of(next_with)
ACT = READY = 50
"""Among the ways to begin a task: after those that look at who begins it."""
ORDER = 5
"""Among what is asked when an operation is done: tools are given back before a job is looked at, or is split."""


def install(build: Any) -> None:
    """Hang the hands on the stations with a task that asks for more than a worker alone."""
    tasks = build.plan.tasks
    crib = install_tools(build)
    wanting = [station for station in build.stations if any(_asks(task) for task in _tasks_at(build, station))]
    if not wanting:
        return
    if crib and any(task.hold for task in tasks):
        tool_holds.install(build)
    if any(task.team > 1 for task in tasks):
        teams.install(build)
    for station in wanting:
        _hang(build, station, crib)


def _tasks_at(build: Any, station: Any) -> list[Any]:
    return [build.plan.tasks[station.tasks[i]] for i in range(station.n_tasks)]


def _asks(task: Any) -> bool:
    return bool(task.needs) or task.hold is not None or task.team > 1 or task.attended


def _hang(build: Any, station: Any, crib: bool) -> None:
    here = _tasks_at(build, station)
    if any(task.needs or task.team > 1 for task in here):
        build.hang(station.readies, ready, None, READY)
    if any(task.needs for task in here) and crib:
        build.hang(station.afters, tasks_done, None, ORDER)
    build.hang(station.acts, act, None, ACT)
    build.hang(station.acteds, acted, None, ACT)
    if crib:
        station.sent = build.hook(sent)


@inlined
def _task(floor: Floor, job: Job) -> Task:
    return floor.tasks[job.station.tasks[job.task_position]]


@step
def ready(floor: Floor, subject: Any, job: Job) -> bool:
    """Whether the task a job has come to may begin: its tools are there, and no team is wanted."""
    if floor.crib and not for_task(floor, job):
        return False
    if floor.teams and _task(floor, job).team > 1:
        call_team(floor, job)
        return False
    return True


@step
def act(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """Another way to begin a task than that of a worker alone; False where it is none of these."""
    if job.setup_task >= 0:
        return False
    task = _task(floor, job)
    if floor.crib and task.n_needs > 0 and not _with_tools(floor, job):
        return False
    if task.team > 1 and floor.teams:
        return come_to_team(floor, job, worker)
    if task.hold_tool >= 0 and floor.holds:
        return act_with_hold(floor, job, worker)
    if task.attended:
        return attend(floor, job, worker)
    return False


@step
def _with_tools(floor: Floor, job: Job) -> bool:
    """Whether somebody who is there can begin with his tools; where the station stands still, they go back."""
    if job.station.down and not job.has_team:
        break_off(floor, floor.subject, job)
        return False
    at_hand(floor, job)
    return True


@step
def acted(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """What follows where a stretch of such a task is over; False where it was the performance's end."""
    if floor.teams and job.has_team:
        return done_in_team(floor, job, worker)
    if floor.holds and job.setup_task < 0:
        return acted_with_hold(floor, job, worker)
    return False
