"""Workers: the states between stretches of their time."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, drop, step
from opsim.engine.floor.parts.clock import on_grid
from opsim.engine.floor.parts.rows import log_worker
from opsim.engine.floor.parts.state import Floor, Job, Worker
from opsim.engine.floor.parts.stretches import stretch
from opsim.log import IDLE, JOB_BLOCKED, SETUP, WAIT, WALK, WORK


@step
def set_free(floor: Floor, worker: Worker) -> None:
    """The worker is idle from now on and can be sent."""
    if worker.kind != WORK and worker.kind != SETUP:  # these are written with the job
        log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = WAIT, IDLE, floor.now
    worker.job = NOTHING
    worker.station = NOTHING
    if not worker.in_free:
        worker.in_free = 1
        floor.none_fits = 0
        floor.free.append(worker)


@step
def be_busy(floor: Floor, worker: Worker) -> None:
    """He can be sent no more."""
    worker.in_free = 0
    drop(floor.free, worker)


@step
def take_off(floor: Floor, worker: Worker, kind: int, cause: int) -> None:
    """A free worker can be sent no more: he has a break, is off, or absent, until ``set_free``."""
    log_worker(floor, worker)
    be_busy(floor, worker)
    worker.kind, worker.cause, worker.since_s = kind, cause, floor.now


@step
def wait_by(floor: Floor, worker: Worker, cause: int) -> None:
    """The worker stands by his job and waits, for a cause."""
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = WAIT, cause, floor.now


@step
def hold(floor: Floor, worker: Worker, job: Job) -> None:
    """The worker stays with a blocked job until it moves."""
    wait_by(floor, worker, JOB_BLOCKED)
    job.held_by = worker


@step
def walk(floor: Floor, worker: Worker, place: int, walk_s: float) -> None:
    """The worker walks to a place and cannot be sent elsewhere before he is there."""
    worker.walk_from = worker.place
    worker.place = place
    worker.kind, worker.since_s = WALK, floor.now
    stretch(floor, worker, floor.stretch_line, on_grid(walk_s))
