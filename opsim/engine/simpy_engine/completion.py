"""What follows when a stretch of time is over: arrivals of walks, ends of performances, automatic ends, new jobs."""

from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import operation_done
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.engine.simpy_engine.station import (
    AUTOMATIC_DONE,
    OPERATION_DONE,
    ended,
    next_task,
    perform,
    proceed,
    task_done,
)
from opsim.engine.simpy_engine.transport import put_down
from opsim.engine.simpy_engine.worker import STRETCH_DONE, hold, log_worker, set_free
from opsim.log import AFTER, BLOCKED, SETUP, TRANSPORT, WALK


def _stretch_done(floor: Floor, worker: Worker) -> None:
    job = worker.job
    if job is None:
        set_free(floor, worker)
    elif job.kind == TRANSPORT:
        put_down(floor, job, worker)
    elif worker.kind == WALK:
        log_worker(floor, worker)
        worker.since_s = floor.now
        perform(floor, job, worker)
    elif job.station.acted is None or not job.station.acted(floor, job, worker):
        performed(floor, job, worker)


def performed(floor: Floor, job: Job, worker: Worker) -> None:
    """A worker has come to the end of a performance."""
    if job.rest_s or job.station.meter is not None:
        ended(floor, job)
    if job.kind == SETUP:
        _set_up(floor, job, worker)
    elif task_done(job):
        operation_over(floor, job, worker)
    else:
        next_task(floor, job, worker)


def operation_over(floor: Floor, job: Job, worker: Worker) -> None:
    """The operation is done, by a worker who stays with the job where it is carried, or held, and has to wait."""
    operation_done(floor, job)
    if (job.plan.carried or floor.plan.when_blocked == "held") and job.number in floor.jobs and _stays(floor, job):
        hold(floor, worker, job)
    else:
        set_free(floor, worker)


def _stays(floor: Floor, job: Job) -> bool:
    """Whether the job waits at the station for room downstream: on its server, or put away with who will carry it."""
    if floor.legs and floor.plan.when_blocked != "held":  # no need to stay with what a vehicle will fetch
        ways = [(job.station.rank, station.rank) for station in job.gate.stations]
        if all(way in floor.legs for way in ways):
            return False
    return job.kind == BLOCKED or (job.plan.carried and job.cause == AFTER)


def _set_up(floor: Floor, job: Job, worker: Worker | None) -> None:
    job.setup_task = -1
    proceed(floor, job, worker)


def _automatic_done(floor: Floor, job: Job) -> None:
    job.over = None
    if job.rest_s or job.station.meter is not None:
        ended(floor, job)
    if job.kind == SETUP:
        _set_up(floor, job, None)
    elif task_done(job):
        operation_done(floor, job)
    else:
        next_task(floor, job, None)


HANDLERS: dict[str, Handler] = {
    STRETCH_DONE: _stretch_done,
    AUTOMATIC_DONE: _automatic_done,
    OPERATION_DONE: operation_done,
}
