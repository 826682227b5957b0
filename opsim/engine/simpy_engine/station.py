"""On a server: task after task, by a worker or automatically."""

from bisect import insort

import simpy

from opsim.clock import on_grid
from opsim.engine.rules import COMPLETION
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.log import HELD, NO_WORKER, WORK

AUTOMATIC_DONE = "automatic task done"


def arrive(floor: Floor, station: Station, job: Job) -> None:
    """The job is at the station: on a server where one is free, else in the queue."""
    if station.free_servers:
        seat(floor, station, job)
    else:
        station.queue.append(job)


def seat(floor: Floor, station: Station, job: Job) -> None:
    """The job takes a free server."""
    station.free_servers -= 1
    job.task_position = job.repeats_done = 0
    next_task(floor, job, None)


def next_task(floor: Floor, job: Job, worker: Worker | None) -> None:
    """Begin the task the job has come to: automatically, by the worker at hand, or by calling for one."""
    station: Station = job.station  # type: ignore[assignment]
    if station.automatic[job.task_position]:
        _run_automatic(floor, station, job)
    elif worker is None:
        floor.job_now(job, HELD, NO_WORKER)
        insort(station.calling, (floor.now, job.number, job))
        floor.calling[station.rank] = station
        floor.calls |= 1 << station.rank
    else:
        perform(floor, job, worker)


def task_done(job: Job) -> bool:
    """Count one performance; True where all tasks of the station are done."""
    repeats = job.station.repeats  # type: ignore[union-attr]
    job.repeats_done += 1
    if job.repeats_done == repeats[job.task_position]:
        job.repeats_done = 0
        job.task_position += 1
    return job.task_position == len(repeats)


def perform(floor: Floor, job: Job, worker: Worker) -> None:
    """The worker's next performance of the job's task begins now."""
    station: Station = job.station  # type: ignore[assignment]
    task = station.tasks[job.task_position]
    luck = worker.luck.get(task)
    if luck is None:
        luck = worker.luck[task] = floor.draws.durations(task, worker.rank)
    k = worker.next_k[task]
    worker.next_k[task] = k + 1
    duration_s = on_grid(next(luck) / worker.rating[station.rank])
    _begin(floor, job, worker.rank, task, k, duration_s)
    worker.kind, worker.since_s = WORK, floor.now
    floor.at_end_of(duration_s, worker.stretch_over)


def _run_automatic(floor: Floor, station: Station, job: Job) -> None:
    task = station.tasks[job.task_position]
    luck = station.luck.get(task)
    if luck is None:
        luck = station.luck[task] = floor.draws.automatic_runs(task, station.rank)
    k = station.next_k.get(task, 0)
    station.next_k[task] = k + 1
    duration_s = on_grid(next(luck))
    _begin(floor, job, -1, task, k, duration_s)
    rank = len(floor.workers) + station.rank
    over = floor.at_end_of(duration_s, simpy.Event(floor.env))
    over.callbacks.append(lambda _: floor.report(COMPLETION, rank, job.number, AUTOMATIC_DONE, job))


def _begin(floor: Floor, job: Job, worker: int, task: int, k: int, duration_s: float) -> None:
    now = floor.now
    if now > job.since_s:
        floor.log_job(job)
    job.kind, job.cause, job.since_s = WORK, 0, now
    job.worker, job.task, job.k, job.duration_s = worker, task, k, duration_s
    job.performance_id = floor.n_performances
    floor.n_performances += 1
