"""A job passes from one member of a crew to another, whatever it is doing at the moment."""

from __future__ import annotations

from opsim.engine.floor.completion import is_fetched
from opsim.engine.floor.interruption import take_over
from opsim.engine.floor.machine import NOTHING, inlined, step
from opsim.engine.floor.parts.claims import claim_at, give_up_claims, put_claim
from opsim.engine.floor.parts.crews import Crew
from opsim.engine.floor.parts.events import stir_gate
from opsim.engine.floor.parts.rows import log_worker
from opsim.engine.floor.parts.state import Floor, Job, Worker
from opsim.engine.floor.station import go_on
from opsim.engine.floor.worker import be_busy, hold, set_free
from opsim.engine.rules.duty import FINISH, FINISH_JOB, RESTART
from opsim.log import AFTER, AWAY, BEHIND, BLOCKED, HELD, JOB_BLOCKED, SETUP, TRANSPORT, WAIT, WALK, WORK


@step
def caught_up(floor: Floor, job: Job) -> bool:
    """Whether somebody who stands at the station of a job may take it there: it has come, and can be left now."""
    if job.kind == WORK and job.worker >= 0:
        rule = floor.tasks[job.task].rule
        if rule in (FINISH, FINISH_JOB, RESTART):
            return False
    if job.with_tools and _on_his_way(floor, job):
        return False
    return job.kind != TRANSPORT


@step
def takes_on(floor: Floor, worker: Worker, job: Job) -> None:
    """A free member who stands at a job has it now: whoever had it is free, and it goes on, or calls where it can."""
    if (job.kind == WORK or job.kind == SETUP) and job.worker >= 0:
        log_worker(floor, worker)
        worker.since_s = floor.now
        be_busy(floor, worker)
        take_over(floor, job, worker)
        return
    if job.held_by:
        put_down(floor, job)
        return
    sent = _on_his_way(floor, job)
    if sent:
        sent.job = NOTHING  # he comes all the same, and is free there
        sent.station = NOTHING
        go_on(floor, job)
    elif job.kind == HELD and job.cause == AWAY:
        go_on(floor, job)


@inlined
def _on_his_way(floor: Floor, job: Job) -> Worker:
    """Who was sent to a job and walks to it."""
    for rank in range(floor.n_workers):
        worker = floor.workers[rank]
        if worker.job is job and worker.kind == WALK:
            return worker
    return floor.no_worker


@step
def must_stay(floor: Floor, job: Job) -> bool:
    """Whether somebody has to stand by a job that waits for room: he is to carry it on, or the floor holds him."""
    if job.held_by:
        return False
    if not (job.kind == BLOCKED or (job.plan.carried and job.cause == AFTER)):
        return False
    if floor.held_when_blocked:
        return True
    return job.plan.carried == 1 and not is_fetched(floor, job)


@step
def stays_with(floor: Floor, worker: Worker, job: Job) -> None:
    """A free member stands by his job until it moves."""
    log_worker(floor, worker)
    worker.since_s = floor.now
    be_busy(floor, worker)
    worker.job, worker.station = job, job.station
    hold(floor, worker, job)
    if not job.ahead and claim_at(job.gate.claims, job) < 0:
        put_claim(floor, job.gate.claims, job, floor.now)
        stir_gate(floor, job.gate)


@step
def put_down(floor: Floor, job: Job) -> None:
    """Who stands by a job is free; what has to be carried goes nowhere before somebody stands by it again."""
    if not job.held_by:
        return
    worker = job.held_by
    job.held_by = NOTHING
    set_free(floor, worker)
    if job.plan.carried and not job.ahead and not is_fetched(floor, job):
        give_up_claims(floor, job.gate.claims, job)


@step
def stands_behind(floor: Floor, crew: Crew, worker: Worker) -> None:
    """Who has just begun to stand by a job that wants on in the line waits for the one ahead of him."""
    if worker.kind == WAIT and worker.cause == JOB_BLOCKED and worker.since_s == floor.now and worker.job:
        for i in range(crew.n_gates):
            if crew.gates[i] is worker.job.gate:
                worker.cause = BEHIND


@step
def waits(floor: Floor, worker: Worker, cause: int) -> None:
    """A free member waits, for a cause."""
    if worker.cause != cause:
        log_worker(floor, worker)
        worker.cause, worker.since_s = cause, floor.now
