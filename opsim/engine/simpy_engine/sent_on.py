"""Jobs that leave a station of a paced line unfinished: whoever is at it is free, and nothing more is done there."""

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.interruption import forget_progress, interrupt
from opsim.engine.simpy_engine.members import disband
from opsim.engine.simpy_engine.state import Job
from opsim.engine.simpy_engine.station import OPERATION_DONE, call_off
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import CLOSED, HELD, IS_DOWN, QUEUE, SENT_ON, SETUP, UNFINISHED, WALK, WORK


def send_on(floor: Floor, job: Job) -> bool:
    """The job's operation is over as it is, and the job is bad; False where its station stands, and so does the line.

    What waits for parts, tools or a worker goes on without them.
    """
    station = job.station
    if job.kind == HELD and job.cause in (IS_DOWN, CLOSED):
        return False
    if job.kind in (WORK, SETUP):
        interrupt(floor, job, UNFINISHED)
    elif job.kind == QUEUE:
        station.queue.remove(job)
    else:
        _wait_no_more(floor, job)
    for told in floor.lost_server:
        told(floor, job, station)
    forget_progress(job)
    job.setup_task, job.bad = -1, True
    floor.log_instant(SENT_ON, job, UNFINISHED, station.rank)
    floor.tell(OPERATION_DONE, job)
    return True


def turn_away(floor: Floor, job: Job, but: int = -1) -> None:
    """Whoever is on his way to the job comes all the same, and is free there; who waits at it is free now."""
    for worker in floor.workers:
        if worker.job is job and worker.rank != but:
            if worker.kind == WALK:
                worker.job = worker.station = None
            else:
                set_free(floor, worker)


def _wait_no_more(floor: Floor, job: Job) -> None:
    call_off(floor, job.station, job)
    for ask in floor.call_off:
        ask(floor, job)
    if job.team is not None:
        disband(floor, job)
    turn_away(floor, job)
    for told in floor.broken_off:
        told(floor, job)
    floor.job_now(job, HELD, UNFINISHED)
