"""What follows when a stretch of time is over: arrivals of walks, ends of performances, automatic ends."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, here, step
from opsim.engine.floor.material import operation_done
from opsim.engine.floor.parts.performing import ended, task_done
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.rows import log_worker
from opsim.engine.floor.parts.state import Floor, Job, Worker
from opsim.engine.floor.station import next_task, perform, proceed
from opsim.engine.floor.transport import put_down
from opsim.engine.floor.worker import hold, set_free
from opsim.log import AFTER, BLOCKED, SETUP, TRANSPORT, WALK


@step
def stretch_done(floor: Floor, event: Event) -> None:
    """A worker's stretch of time is over."""
    worker = event.worker
    job = worker.job
    if not job:
        set_free(floor, worker)
    elif job.kind == TRANSPORT:
        put_down(floor, job, worker)
    elif worker.kind == WALK:
        log_worker(floor, worker)
        worker.since_s = floor.now
        perform(floor, job, worker)
    else:
        acteds = job.station.acteds
        for hook in acteds:
            if hook.line(floor, hook.subject, job, worker):
                return
        _performed(floor, job, worker)


@step
def performed(floor: Floor, job: Job, worker: Worker) -> None:
    """A worker has come to the end of a performance."""
    ended(floor, job)
    if job.kind == SETUP:
        job.setup_task = -1
        proceed(floor, job, worker)
    elif task_done(job):
        _operation_over(floor, job, worker)
    else:
        next_task(floor, job, worker)


@step
def operation_over(floor: Floor, job: Job, worker: Worker) -> None:
    """The operation is done, by a worker who stays with the job where it is carried, or held, and has to wait."""
    may_stay = job.plan.carried or floor.held_when_blocked
    floor.at_once = floor.alone and not may_stay
    floor.done = job
    _operation_done(floor, job)
    floor.at_once = 0
    if may_stay and floor.done is job and _stays(floor, job):
        hold(floor, worker, job)
    else:
        set_free(floor, worker)


@step
def _stays(floor: Floor, job: Job) -> bool:
    """Whether the job waits at the station for room downstream: on its server, or put away with who will carry it."""
    if floor.has_legs and not floor.held_when_blocked and is_fetched(floor, job):
        return False
    return job.kind == BLOCKED or (job.plan.carried == 1 and job.cause == AFTER)


@step
def is_fetched(floor: Floor, job: Job) -> bool:
    """Whether a vehicle comes for it, whichever of its next stations it goes to."""
    if not floor.has_legs or job.station.rank < 0:
        return False
    gate = job.gate
    for i in range(gate.n_stations):
        if not floor.legs[job.station.rank * floor.n_stations + gate.stations[i].rank]:
            return False
    return True


@step
def automatic_done(floor: Floor, event: Event) -> None:
    """An automatic run is over."""
    job = event.job
    job.over = NOTHING
    ended(floor, job)
    if job.kind == SETUP:
        job.setup_task = -1
        proceed(floor, job, floor.no_worker)
    elif task_done(job):
        floor.at_once = floor.alone
        _operation_done(floor, job)
        floor.at_once = 0
    else:
        next_task(floor, job, floor.no_worker)


_performed, _operation_over, _operation_done = here(performed), here(operation_over), here(operation_done)
