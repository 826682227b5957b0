"""Jobs that leave a station of a paced line unfinished: whoever is at it is free, and nothing more is done there."""

from __future__ import annotations

from opsim.engine.floor.interruption import forget_progress, interrupt, tell_broken_off
from opsim.engine.floor.machine import NOTHING, drop, inlined, step
from opsim.engine.floor.members import disband
from opsim.engine.floor.parts.rows import job_now, log_instant
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.floor.station import call_off
from opsim.engine.floor.worker import set_free
from opsim.log import CLOSED, HELD, IS_DOWN, QUEUE, SENT_ON, SETUP, UNFINISHED, WALK, WORK


@step
def send_on(floor: Floor, job: Job) -> bool:
    """The job's operation is over as it is, and the job is bad; False where its station stands, and so does the line.

    What waits for parts, tools or a worker goes on without them.
    """
    station = job.station
    if job.kind == HELD and (job.cause == IS_DOWN or job.cause == CLOSED):
        return False
    if job.kind == WORK or job.kind == SETUP:
        interrupt(floor, job, UNFINISHED)
    elif job.kind == QUEUE:
        drop(station.queue, job)
    else:
        _wait_no_more(floor, job)
    tell_lost_server(floor, job)
    forget_progress(floor, job)
    job.setup_task, job.bad = -1, 1
    log_instant(floor, SENT_ON, job, UNFINISHED, station.rank, -1)
    floor.operation_line(floor, job)
    return True


@step
def tell_lost_server(floor: Floor, job: Job) -> None:
    """Whoever has to know that a job loses what it had at its server."""
    for told in floor.lost_server:
        told.line(floor, told.subject, job, job.station)


@step
def turn_away(floor: Floor, job: Job, but: int) -> None:
    """Whoever is on his way to the job comes all the same, and is free there; who waits at it is free now."""
    for rank in range(floor.n_workers):
        worker = floor.workers[rank]
        if worker.job is job and rank != but:
            if worker.kind == WALK:
                worker.job = NOTHING
                worker.station = NOTHING
            else:
                set_free(floor, worker)


@inlined
def _wait_no_more(floor: Floor, job: Job) -> None:
    call_off(floor, job.station, job)
    for hook in floor.call_off:
        _ = hook.line(floor, hook.subject, job)
    if job.has_team:
        disband(floor, job)
    turn_away(floor, job, -1)
    tell_broken_off(floor, job)
    job_now(floor, job, HELD, UNFINISHED)
