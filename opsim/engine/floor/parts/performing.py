"""Performances: which task is next, how long it takes, when it begins and ends."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined
from opsim.engine.floor.parts.clock import on_grid
from opsim.engine.floor.parts.effects import works
from opsim.engine.floor.parts.luck import AUTOMATIC, DURATION, next_number, stream_of
from opsim.engine.floor.parts.rows import log_job
from opsim.engine.floor.parts.state import Floor, Job, Station, Worker
from opsim.log import SETUP, WORK


@inlined
def is_ready(floor: Floor, station: Station, job: Job) -> bool:
    """Whether nothing keeps the task a job has come to from beginning."""
    for ready in station.readies:
        if not ready.line(floor, ready.subject, job):
            return False
    return True


@inlined
def units(job: Job) -> int:
    """How many units of a lot the job's task is done for, each by itself."""
    return 1 if job.station.per_lot[job.task_position] else job.lot


@inlined
def task_done(job: Job) -> bool:
    """Count one performance; True where all tasks of the station are done."""
    station = job.station
    job.repeats_done += 1
    if job.repeats_done == station.repeats[job.task_position] * units(job):
        job.repeats_done = 0
        job.task_position += 1
    return job.task_position == station.n_tasks


@inlined
def task_of(job: Job) -> int:
    """The task a job has come to, or the set-up it is in or called for."""
    return job.station.tasks[job.task_position] if job.setup_task < 0 else job.setup_task


@inlined
def own_next_s(floor: Floor, worker: Worker, task: int) -> float:
    """The worker's own next time of a task, at rating 1, without human effects; ``floor.asked_k`` is its number."""
    luck = worker.luck[task]
    if not luck:
        luck = stream_of(floor, DURATION, worker.rank, task, 0)
        worker.luck[task] = luck
    k = worker.next_k[task]
    worker.next_k[task] = k + 1
    floor.asked_k = k
    return next_number(floor, luck)


@inlined
def drawn_run_s(floor: Floor, station: Station, task: int) -> float:
    """The station's next duration of an automatic run of a task; its number k is ``floor.asked_k``."""
    luck = station.luck[task]
    if not luck:
        luck = stream_of(floor, AUTOMATIC, station.rank, task, 0)
        station.luck[task] = luck
    k = station.next_k[task]
    station.next_k[task] = k + 1
    floor.asked_k = k
    return on_grid(next_number(floor, luck))


@inlined
def begin(floor: Floor, job: Job, worker: int, task: int, k: int, duration_s: float) -> None:
    """A performance, or the rest of one, begins: the job is in work from now on."""
    log_job(floor, job)
    job.kind = WORK if job.setup_task < 0 else SETUP
    job.cause, job.since_s = 0, floor.now
    if not job.rest_s or job.worker != worker or job.k != k:  # a rest by the same performer is the same performance
        job.performance_id = floor.n_performances
        floor.n_performances += 1
        job.pace_shift = floor.workers[worker].pace_shift if worker >= 0 else 0.0
    if worker >= 0:
        works(floor, floor.workers[worker], task, floor.now + duration_s, job.progress_from, k)
    job.worker, job.task, job.k, job.duration_s = worker, task, k, duration_s
    meter = job.station.meter
    if meter:
        meter.begin_line(floor, meter)


@inlined
def ended(floor: Floor, job: Job) -> None:
    """A performance of the job is over, to its end; its row is written when the job's state changes."""
    if job.rest_s:
        log_job(floor, job)  # the last piece, while it is known where it began
        job.since_s = floor.now
        job.progress_from = 0.0
        job.rest_s = 0.0
    meter = job.station.meter
    if meter:
        meter.end_line(floor, meter)
