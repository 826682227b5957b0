"""A tool in the hands between two moments of a performance: who finds none free at the first of them waits there."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.event_list import on_grid, on_grid_from_0, stretch
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import progress
from opsim.engine.floor.machine import NOTHING, fresh, give_back, inlined, line_of, step
from opsim.engine.floor.random_numbers import HOLD, HOLD_RUN, next_held, stream_of
from opsim.engine.floor.state import Job, Station, Worker
from opsim.log import CLOSED, NO_TOOL, WAIT, WORK
from opsim.subjects.people.worker import begin, set_free, stops, time_here_s, wait_by
from opsim.subjects.stations.station import stand_still
from opsim.subjects.tools.tool_grips import Doing, Want
from opsim.subjects.tools.tool_store import IN_HAND, put_back, take

_new_doing, _forget_doing = fresh(Doing), give_back(Doing)
_new_want, _forget_want = fresh(Want), give_back(Want)


def install(build: Any) -> None:
    """The performances of a floor in which a tool is held."""
    plan, floor = build.plan, build.floor
    made = floor.holds = build.arena.new("Holds")
    made.of_workers = build.ints([0] * len(plan.workers) * len(plan.tasks))
    made.of_stations = build.ints([0] * len(plan.stations) * len(plan.tasks))
    made.wanted = build.arena.array("Want", [_wanted(build, task) for task in plan.tasks])
    build.line(given)
    build.hang(floor.left_station, leave_hold)


def _wanted(build: Any, task: Any) -> Any:
    """The tool that is held in a task."""
    if task.hold is None:
        return None
    made = build.arena.new("Want")
    made.n_needs, made.needs = 1, build.ints((task.hold.tool, 1))
    return made


@step
def act_with_hold(floor: Floor, job: Job, worker: Worker) -> bool:
    """The worker begins, or goes on with what was broken off; False where the station stands still."""
    station = job.station
    if station.down:
        return False
    attended = floor.tasks[station.tasks[job.task_position]].attended
    if _goes_on(job, worker, attended):
        _take_up(floor, job, worker, attended)
    else:
        if not job.rest_s:
            put_back(floor, job, IN_HAND)
        _draw(floor, job, worker)
    doing = job.block.doing
    worker.since_s = floor.now
    doing.at_work = 0
    _go(floor, job, doing)
    return True


@inlined
def _goes_on(job: Job, worker: Worker, attended: int) -> bool:
    """Whether the worker goes on with what was begun, or drawn."""
    doing = job.block.doing
    if not doing:
        return False
    return (doing.worker is worker or attended == 1) and _is_as_it_was(job, doing)


@inlined
def _is_as_it_was(job: Job, doing: Doing) -> bool:
    """Whether nothing of what was done of a performance, or before it was drawn, was lost since."""
    return job.rest_s > 0 if doing.begun else doing.before == job.progress_from


@step
def _take_up(floor: Floor, job: Job, worker: Worker, attended: int) -> None:
    """The worker goes on with a performance."""
    doing = job.block.doing
    doing.worker = worker
    if attended:
        worker.pace_shift = 0.0
    if _is_to_begin(floor, job, doing):
        _ask_again(floor, job, doing)
    elif doing.begun:
        _pass_by(doing, doing.left_s - job.rest_s)


@inlined
def _pass_by(doing: Doing, spent_s: float) -> None:
    """So much of the work is done."""
    doing.left_s -= spent_s
    doing.start_s -= spent_s
    doing.end_s -= spent_s


@step
def acted_with_hold(floor: Floor, job: Job, worker: Worker) -> bool:
    """A stretch is over: the tool is taken or given back; False where the performance is done."""
    doing = job.block.doing
    if not doing or doing.worker is not worker:
        return False
    _pass_by(doing, doing.stretch_s)
    if doing.left_s > 0:
        _go(floor, job, doing)
        return True
    job.block.doing = NOTHING
    _forget_doing(floor, doing)
    put_back(floor, job, IN_HAND)
    return False


@step
def leave_hold(floor: Floor, subject: Any, job: Job, station: Station) -> None:
    """The job is gone: who stood by and waited for its tool is free."""
    doing = job.block.doing
    if not doing:
        return
    job.block.doing = NOTHING
    worker = doing.worker
    if worker.job is job and worker.kind == WAIT:
        set_free(floor, worker)


@step
def _go(floor: Floor, job: Job, doing: Doing) -> None:
    """On to the next moment; or the worker waits by the job where the tool is wanted now and none is free."""
    if doing.start_s <= 0 and doing.end_s > 0:
        done = progress(job, floor.now) if doing.at_work else 0.0
        if not _take_tool(floor, job, doing):
            _pause(floor, job, doing, done)
            return
    elif doing.end_s <= 0 or not doing.at_work:  # who takes over may have it for nothing yet
        put_back(floor, job, IN_HAND)
    _stretch(floor, job, doing)


@inlined
def _take_tool(floor: Floor, job: Job, doing: Doing) -> bool:
    """Whether the job has the tool, or takes it now; else it waits for it."""
    wanted, want = floor.holds.wanted[doing.task], _new_want(floor)
    want.job, want.purpose, want.task, want.doing = job, IN_HAND, doing.task, doing
    want.n_needs, want.needs, want.go_on_line, want.at_once = wanted.n_needs, wanted.needs, line_of_given, 1
    taken = take(floor, job, want)
    if taken:
        _forget_want(floor, want)
    return taken


@step
def _stretch(floor: Floor, job: Job, doing: Doing) -> None:
    """He works, until the next moment or the end."""
    worker = doing.worker
    if not doing.at_work:
        begin(floor, job, worker.rank, doing.task, doing.k, doing.left_s)
        worker.kind, worker.since_s = WORK, floor.now
        doing.at_work = doing.begun = 1
    stretch_s = doing.left_s
    if doing.end_s > 0 and doing.end_s < stretch_s:
        stretch_s = doing.end_s
    if doing.start_s > 0 and doing.start_s < stretch_s:
        stretch_s = doing.start_s
    doing.stretch_s = stretch_s
    stretch(floor, worker, floor.stretch_line, stretch_s)


@step
def _pause(floor: Floor, job: Job, doing: Doing, done: float) -> None:
    """He stands by and waits for the tool."""
    if doing.at_work:
        doing.at_work = 0
        job.rest_s, job.progress_from = doing.left_s, done
        meter = job.station.meter
        if meter:
            meter.end_line(floor, meter)
        stops(floor, doing.worker)
    wait_by(floor, doing.worker, NO_TOOL)


@step
def given(floor: Floor, want: Want) -> None:
    """The tool that was waited for is there."""
    job, doing = want.job, want.doing
    station, worker = job.station, doing.worker
    at_once = doing.begun == 1 and worker.since_s == floor.now  # he has not waited for it at all
    if station.down and not (at_once and _finishes(station)):
        put_back(floor, job, IN_HAND)
        set_free(floor, worker)
        stand_still(floor, station, job)
        return
    wait_by(floor, worker, NO_TOOL)  # writes the wait until now
    if _is_to_begin(floor, job, doing):
        _ask_again(floor, job, doing)
    _stretch(floor, job, doing)


@inlined
def _finishes(station: Station) -> bool:
    """Whether it is closed, and nothing else keeps it from finishing what was begun before."""
    return station.down == 1 and station.stands_for == CLOSED and station.finishes_at_close == 1


@step
def _draw(floor: Floor, job: Job, worker: Worker) -> None:
    """The worker's next performance, or what is left of the job's task at his own pace; all on the grid."""
    station, n_tasks = job.station, floor.n_tasks
    doing: Doing = _new_doing(floor)
    task = station.tasks[job.task_position]
    doing.worker, doing.task = worker, task
    if floor.tasks[task].attended:
        at = station.rank * n_tasks + task
        if not floor.holds.of_stations[at]:
            floor.holds.of_stations[at] = stream_of(floor, HOLD_RUN, station.rank, task, 0)
        doing.drawn_s = next_held(floor, floor.holds.of_stations[at])
        doing.k = station.next_k[task]
        station.next_k[task] = doing.k + 1
        worker.pace_shift = 0.0
    else:
        at = worker.rank * n_tasks + task
        if not floor.holds.of_workers[at]:
            floor.holds.of_workers[at] = stream_of(floor, HOLD, worker.rank, task, 0)
        doing.drawn_s = next_held(floor, floor.holds.of_workers[at])
        doing.k = worker.next_k[task]
        worker.next_k[task] = doing.k + 1
    doing.drawn_start, doing.drawn_end = floor.holds.start, floor.holds.end
    job.block.doing = doing
    _time(floor, job, doing)


@inlined
def _is_to_begin(floor: Floor, job: Job, doing: Doing) -> bool:
    """Whether somebody with human effects has done nothing yet of a time of his own."""
    if not doing.worker.human or floor.tasks[doing.task].attended:
        return False
    return doing.before == job.progress_from


@step
def _ask_again(floor: Floor, job: Job, doing: Doing) -> None:
    """Human effects are those of when it truly begins."""
    _time(floor, job, doing)
    job.pace_shift = doing.worker.pace_shift


@step
def _time(floor: Floor, job: Job, doing: Doing) -> None:
    """What is left of the job's task at the pace of what was drawn; all on the grid."""
    whole_s = on_grid(doing.drawn_s)
    if not floor.tasks[doing.task].attended:
        whole_s = time_here_s(floor, job.station, doing.worker, doing.task, doing.k, doing.drawn_s)
    doing.left_s = on_grid(whole_s * (1.0 - job.progress_from)) if job.rest_s else whole_s
    doing.start_s = on_grid_from_0(doing.drawn_start * whole_s) - (whole_s - doing.left_s)
    doing.end_s = on_grid_from_0(doing.drawn_end * whole_s) - (whole_s - doing.left_s)
    doing.before, doing.stretch_s, doing.at_work = job.progress_from, 0.0, 0


line_of_given = line_of(given)
