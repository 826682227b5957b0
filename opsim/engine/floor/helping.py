"""Two at one task: who helps takes his own share of what is left, and both are done at once."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.interruption import release_team
from opsim.engine.floor.machine import fresh, inlined, step
from opsim.engine.floor.parts.clock import on_grid
from opsim.engine.floor.parts.effects import stop, works
from opsim.engine.floor.parts.rows import log_job, progress
from opsim.engine.floor.parts.state import Floor, Job, Worker
from opsim.engine.floor.parts.stints import Stint
from opsim.engine.floor.parts.stretches import stretch
from opsim.engine.floor.station import drawn_s
from opsim.engine.rules import lines
from opsim.log import WORK

OUTERMOST = -100
"""Among what follows when a stretch is over: who helps is free before anything else."""
_together_s = inlined(lines.together_s)
_new_stint = fresh(Stint)


@step
def begin_helping(floor: Floor, job: Job, worker: Worker) -> None:
    """From now on two are at the task, whose rest goes by the sum of their paces."""
    station, now = job.station, floor.now
    done = progress(job, now)
    alone_s = job.since_s + job.duration_s - now
    his_s = drawn_s(floor, station, worker, job.task)
    k = floor.asked_k
    rest_s = on_grid(_together_s(alone_s, his_s * (1.0 - done)))
    job.block.helped, job.block.slower = 1, alone_s / rest_s
    _go_on_at_another_pace(floor, job, done, rest_s)
    stint: Stint = _new_stint(floor)
    stint.station, stint.product, stint.operation, stint.task = station.rank, job.product, job.operation, job.task
    stint.performance_id, stint.k, stint.duration_s = _another(floor), k, rest_s
    stint.progress_from, stint.pace_shift = done, worker.pace_shift
    worker.stint = stint
    works(floor, worker, job.task, now + rest_s, done, k)
    worker.job, worker.station = job, station
    worker.kind, worker.since_s = WORK, now
    job.has_team = 1
    job.team.clear()
    job.team.append(worker)


@step
def end(floor: Floor, job: Job) -> None:
    """Who helps has to go, and the other one goes on alone."""
    rest_s = (job.since_s + job.duration_s - floor.now) * job.block.slower
    job.block.helped = 0
    _go_on_at_another_pace(floor, job, progress(job, floor.now), on_grid(rest_s))
    release_team(floor, job)


@step
def help_broken_off(floor: Floor, subject: Any, job: Job) -> None:
    """Who goes on alone needs longer for the rest."""
    if job.block.helped:
        job.block.helped = 0
        if job.rest_s:
            job.rest_s = on_grid(job.rest_s * job.block.slower)
            job.performance_id = _another(floor)


@step
def help_over(floor: Floor, subject: Any, job: Job, worker: Worker) -> bool:
    """Who helps is free when the task is done; what else follows is asked too."""
    if job.block.helped:
        job.block.helped = 0
        release_team(floor, job)
    return False


@inlined
def _go_on_at_another_pace(floor: Floor, job: Job, done: float, rest_s: float) -> None:
    """Who works at the job goes on, and needs another time for the rest: a piece of its own begins."""
    worker = floor.workers[job.worker]
    log_job(floor, job)
    job.since_s, job.progress_from, job.rest_s, job.duration_s = floor.now, done, rest_s, rest_s
    job.performance_id = _another(floor)
    stop(floor, worker)
    worker.since_s = floor.now
    works(floor, worker, job.task, floor.now + rest_s, done, job.k)
    stretch(floor, worker, floor.stretch_line, rest_s)


@inlined
def _another(floor: Floor) -> int:
    """The number of a performance, or of a part of one that goes at a pace of its own."""
    number = floor.n_performances
    floor.n_performances = number + 1
    return number


@step
def can_help(floor: Floor, job: Job) -> bool:
    """Whether somebody works at a task that two can share: one without a tool in the hands or a time of the station."""
    if job.kind != WORK or job.worker < 0:
        return False
    task = floor.tasks[job.task]
    return task.hold_tool < 0 and not task.attended


def hang_helping(build: Any, ranks: tuple[int, ...]) -> None:
    """Help can be had at some stations."""
    if not build.floor.helping:
        build.floor.helping = build.arena.new("Helping")
        build.hang(build.floor.broken_off, help_broken_off)
    for rank in ranks:
        build.hang(build.stations[rank].acteds, help_over, None, OUTERMOST)
