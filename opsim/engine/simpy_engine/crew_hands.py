"""A job passes from one member of a crew to another, whatever it is doing at the moment."""

from bisect import insort

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.interruption import take_over
from opsim.engine.simpy_engine.state import Gate, Job, Worker, claim_of
from opsim.engine.simpy_engine.station import go_on
from opsim.engine.simpy_engine.worker import hold, log_worker, set_free
from opsim.log import (
    AFTER,
    AWAY,
    BEHIND,
    BLOCKED,
    HELD,
    JOB_BLOCKED,
    NO_PLACE,
    QUEUE,
    SETUP,
    TRANSPORT,
    WAIT,
    WALK,
    WORK,
)

UNBROKEN = ("finish", "finish_job", "restart")
"""The rules of interruption of a task that nobody takes over in the middle."""


def caught_up(floor: Floor, job: Job) -> bool:
    """Whether somebody who stands at the station of a job may take it there: it has come, and can be left now."""
    if job.kind == WORK and job.worker >= 0 and floor.plan.tasks[job.task].interruption in UNBROKEN:
        return False
    return job.kind != TRANSPORT and not (job.with_tools and _on_his_way(floor, job) is not None)


def takes_on(floor: Floor, worker: Worker, job: Job) -> None:
    """A free member who stands at a job has it now: whoever had it is free, and it goes on, or calls where it can."""
    if (job.kind == WORK or job.kind == SETUP) and job.worker >= 0:
        log_worker(floor, worker)
        worker.since_s = floor.now
        del floor.free[worker.rank]
        take_over(floor, job, worker)
    elif job.held_by is not None:
        put_down(floor, job)
    elif (sent := _on_his_way(floor, job)) is not None:
        sent.job = sent.station = None  # he comes all the same, and is free there
        go_on(floor, job)
    elif job.kind == HELD and job.cause == AWAY:
        go_on(floor, job)


def _on_his_way(floor: Floor, job: Job) -> Worker | None:
    """Who was sent to a job and walks to it."""
    return next((worker for worker in floor.workers if worker.job is job and worker.kind == WALK), None)


def is_stuck(job: Job, done_here: list[Job]) -> bool:
    """Whether a job waits for room, for a server, or for who is ahead of it."""
    waits_for_place = job.kind == HELD and job.cause == NO_PLACE
    return job.kind == BLOCKED or job.kind == QUEUE or waits_for_place or job in done_here


def must_stay(floor: Floor, job: Job) -> bool:
    """Whether somebody has to stand by a job that waits for room: he is to carry it on, or the floor holds him."""
    carried = job.plan.carried
    if job.held_by is not None or not (job.kind == BLOCKED or (carried and job.cause == AFTER)):
        return False
    return floor.plan.when_blocked == "held" or (carried and not _is_fetched(floor, job))


def _is_fetched(floor: Floor, job: Job) -> bool:
    """Whether a vehicle comes for it."""
    ways = [(job.station.rank, station.rank) for station in job.gate.stations]
    return bool(floor.legs) and all(way in floor.legs for way in ways)


def stays_with(floor: Floor, worker: Worker, job: Job) -> None:
    """A free member stands by his job until it moves."""
    log_worker(floor, worker)
    worker.since_s = floor.now
    del floor.free[worker.rank]
    worker.job, worker.station = job, job.station
    hold(floor, worker, job)
    if job.ahead is None and all(claim[3] is not job for claim in job.gate.claims):
        insort(job.gate.claims, claim_of(job, floor.now))
        floor.stirred.add(job.gate)


def put_down(floor: Floor, job: Job) -> None:
    """Who stands by a job is free; what has to be carried goes nowhere before somebody stands by it again."""
    if job.held_by is not None:
        worker, job.held_by = job.held_by, None
        set_free(floor, worker)
        if job.plan.carried and job.ahead is None and not _is_fetched(floor, job):
            job.gate.claims = [claim for claim in job.gate.claims if claim[3] is not job]


def stands_behind(floor: Floor, worker: Worker, gates: list[Gate]) -> None:
    """Who has just begun to stand by a job that wants on in the line waits for the one ahead of him."""
    if worker.kind == WAIT and worker.cause == JOB_BLOCKED and worker.since_s == floor.now:
        job = worker.job
        if job is not None and job.gate in gates:
            worker.cause = BEHIND


def waits(floor: Floor, worker: Worker, cause: int) -> None:
    """A free member waits, for a cause."""
    if worker.cause != cause:
        log_worker(floor, worker)
        worker.cause, worker.since_s = cause, floor.now
