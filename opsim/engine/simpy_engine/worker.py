"""Workers: the process that spends their time, and the states between."""

from collections.abc import Generator
from math import nan

import simpy

from opsim.clock import on_grid
from opsim.engine.rules import COMPLETION
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.log import IDLE, JOB_BLOCKED, SETUP, WAIT, WALK, WORK, pack_row

STRETCH_DONE = "stretch done"


def working_life(floor: Floor, worker: Worker) -> Generator[simpy.Event, None, None]:
    """The SimPy process of a worker: spend the stretch of time he was given, report it, wait for the next."""
    env, report, rank = floor.env, floor.report, worker.rank
    while True:
        try:
            yield worker.stretch_over
        except simpy.Interrupt:  # the stretch means nothing any more; another event is in its place
            continue
        worker.stretch_over = simpy.Event(env)
        report(COMPLETION, rank, 0, STRETCH_DONE, worker)


def stop(floor: Floor, worker: Worker) -> None:
    """The stretch under way means nothing any more, and the worker is given another event to wait for."""
    worker.stretch_over = simpy.Event(floor.env)
    if worker.human is not None:
        worker.human.stops(floor.now)
    process = worker.process
    if process is not None and process is not floor.env.active_process:
        process.interrupt()


def set_free(floor: Floor, worker: Worker) -> None:
    """The worker is idle from now on and can be sent."""
    if worker.kind != WORK and worker.kind != SETUP:  # these are written with the job
        log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = WAIT, IDLE, floor.now
    worker.job = worker.station = None
    floor.free[worker.rank] = worker


def take_off(floor: Floor, worker: Worker, kind: int, cause: int = 0) -> None:
    """A free worker can be sent no more: he has a break, is off, or absent, until ``set_free``."""
    log_worker(floor, worker)
    del floor.free[worker.rank]
    worker.kind, worker.cause, worker.since_s = kind, cause, floor.now


def hold(floor: Floor, worker: Worker, job: Job) -> None:
    """The worker stays with a blocked job until it moves."""
    wait_by(floor, worker, JOB_BLOCKED)
    job.held_by = worker


def wait_by(floor: Floor, worker: Worker, cause: int) -> None:
    """The worker stands by his job and waits, for a cause."""
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = WAIT, cause, floor.now


def walk(floor: Floor, worker: Worker, place: int, walk_s: float) -> None:
    """The worker walks to a place and cannot be sent elsewhere before he is there."""
    worker.walk_from, worker.place = worker.place, place
    worker.kind, worker.since_s = WALK, floor.now
    floor.at_end_of(on_grid(walk_s), worker.stretch_over)


def log_worker(floor: Floor, worker: Worker) -> None:
    """Write the wait or the walk the worker was in until now; work is written with the job, unless a team does it."""
    now, kind = floor.now, worker.kind
    if now <= worker.since_s:
        return
    if kind == WORK or kind == SETUP:  # noqa: SIM109
        if worker.stint is not None:
            worker.stint.log(floor, worker)
        return
    walking = kind == WALK
    job, station = worker.job, worker.station
    place_from, cause = (worker.walk_from, 0) if walking else (worker.place, worker.cause)
    if job is None:
        source = number = product = operation = -1
    else:
        source, number, product, operation = job.source, job.number, job.product, job.operation_rank
    floor.write(pack_row(
        kind, worker.since_s, now, worker.rank, -1 if station is None else station.rank,
        place_from, worker.place, source, number, product, operation,
        -1, -1, -1, nan, nan, nan, cause,
    ))  # fmt: skip
