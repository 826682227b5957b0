"""Workers: the process that spends their time, and the states between."""

from collections.abc import Generator

import simpy

from opsim.engine.rules import COMPLETION
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.log import IDLE, JOB_BLOCKED, WAIT, WALK, row

STRETCH_DONE = "stretch done"


def working_life(floor: Floor, worker: Worker) -> Generator[simpy.Event, None, None]:
    """The SimPy process of a worker: spend the stretch of time he was given, report it, wait for the next."""
    while True:
        worker.stretch_over = simpy.Event(floor.env)
        yield worker.stretch_over
        floor.report(COMPLETION, worker.rank, 0, STRETCH_DONE, worker)


def set_free(floor: Floor, worker: Worker) -> None:
    """The worker is idle from now on and can be sent."""
    _wait(floor, worker, IDLE)
    worker.job = worker.station = None
    floor.free[worker.rank] = worker


def hold(floor: Floor, worker: Worker, job: Job) -> None:
    """The worker stays with a blocked job until it moves."""
    _wait(floor, worker, JOB_BLOCKED)
    job.held_by = worker


def log_worker(floor: Floor, worker: Worker) -> None:
    """Write the wait or the walk the worker was in until now; work is written with the job."""
    now = floor.now
    if now > worker.since_s and worker.kind in (WAIT, WALK):
        floor.log.append(_row(worker, now))


def _wait(floor: Floor, worker: Worker, cause: int) -> None:
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = WAIT, cause, floor.now


def _row(worker: Worker, now: float) -> tuple:
    walking = worker.kind == WALK
    place_from = worker.walk_from if walking else worker.place
    if worker.station is None or worker.job is None:
        return row(worker.kind, worker.since_s, now, worker.rank, -1, place_from, worker.place, cause=worker.cause)
    station, job = worker.station, worker.job
    return row(
        *(worker.kind, worker.since_s, now, worker.rank, station.rank, place_from, station.plan.place),
        *(0, job.number, job.product, job.operation_rank),
        cause=0 if walking else worker.cause,
    )
