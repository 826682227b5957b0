"""Who works, and with what in his hands: tools, holds, teams and attended runs, where tasks ask for them."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor import holds, teams, tools
from opsim.engine.floor.attended import attend
from opsim.engine.floor.crib import break_off, sent
from opsim.engine.floor.holds import act_with_hold, acted_with_hold
from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.records import Task
from opsim.engine.floor.parts.state import Floor, Job, Worker
from opsim.engine.floor.teams import call_team, come_to_team, done_in_team
from opsim.engine.floor.tools import at_hand, for_task, tasks_done

ACT = READY = 50
"""Among the ways to begin a task: after those that look at who begins it."""
ORDER = 5
"""Among what is asked when an operation is done: tools are given back before a job is looked at, or is split."""


def install(build: Any) -> None:
    """Hang the hands on the stations with a task that asks for more than a worker alone."""
    tasks = build.plan.tasks
    crib = tools.install(build)
    wanting = [station for station in build.stations if any(_asks(task) for task in _tasks_at(build, station))]
    if not wanting:
        return
    if crib and any(task.hold for task in tasks):
        holds.install(build)
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
