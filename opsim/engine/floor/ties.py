"""Jobs that wait for one worker: for him who began the task, or who has to carry them."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.allocation import send
from opsim.engine.floor.completion import is_fetched
from opsim.engine.floor.machine import NOTHING, inlined, step
from opsim.engine.floor.parts.claims import claim_at, give_up_claims, put_claim, take_claim
from opsim.engine.floor.parts.gates import may_enter, want_in
from opsim.engine.floor.parts.performing import is_ready
from opsim.engine.floor.parts.state import CREWS, Floor, Job, Station, Worker
from opsim.engine.floor.relief import best_free
from opsim.engine.floor.station import go_on
from opsim.engine.floor.worker import hold, set_free
from opsim.log import HELD


@inlined
def tie(floor: Floor, worker: Worker, job: Job) -> None:
    """The job waits for him, whether he has left it on its server or goes to carry it. He has no other."""
    if not worker.tied:
        floor.people.n_tied += 1
    worker.tied = job


@inlined
def _untie_from(floor: Floor, worker: Worker) -> None:
    worker.tied = NOTHING
    floor.people.n_tied -= 1


@step
def put_down(floor: Floor, worker: Worker, job: Job) -> None:
    """He leaves the blocked job he stands by; what he has to carry goes nowhere before he is back."""
    job.held_by = NOTHING
    set_free(floor, worker)
    if job.plan.carried and not is_fetched(floor, job):
        give_up_claims(floor, job.gate.claims, job)
        if not worker.limited[CREWS]:  # else whoever of his crew comes to it carries it on
            tie(floor, worker, job)


@step
def untie(floor: Floor, subject: Any, job: Job, station: Station) -> None:
    """The job is gone, or has lost its server: it waits for nobody."""
    people = floor.people
    if people.n_tied:
        for rank in range(floor.n_workers):
            if floor.workers[rank].tied is job:
                _untie_from(floor, floor.workers[rank])
    if people.left:
        give_up_claims(floor, people.left, job)


@step
def goes_off(floor: Floor, worker: Worker) -> None:
    """His shift is over: what he has to carry is for anybody; what he began waits on for him."""
    if worker.tied:
        job = worker.tied
        if job.kind != HELD:
            _untie_from(floor, worker)
            put_claim(floor, floor.people.left, job, floor.now)


@step
def release(floor: Floor, worker: Worker) -> None:
    """He does not come: what he began is for anybody."""
    if worker.tied:
        job = worker.tied
        if job.kind == HELD:
            _untie_from(floor, worker)
            go_on(floor, job)


@step
def send_carriers(floor: Floor) -> bool:
    """Where there is room for a job that nobody carries, send who is free and may serve its station, by the rule of
    allocation. True where somebody goes.
    """
    people, sent = floor.people, False
    people.left_jobs.clear()
    people.left_since_s.clear()
    for one in people.left:
        people.left_jobs.append(one.job)
        people.left_since_s.append(one.since_s)
    for i in range(len(people.left_jobs)):
        job = people.left_jobs[i]
        at = claim_at(people.left, job)
        if at >= 0 and may_enter(floor, job.gate, job):
            carrier = best_free(floor, job.station, job, people.left_since_s[i], True)
            if carrier:
                take_claim(floor, people.left, at)
                tie(floor, carrier, job)
                send(floor, carrier, job.station, job)
                sent = True
    return sent


@step
def go_back(floor: Floor, worker: Worker) -> bool:
    """Send somebody who is free, and back, to the job that waits for him; True where there was one.

    Where its station stands still, or its tools are gone, the job has to wait, and is for anybody then.
    """
    if not worker.tied:
        return False
    job = worker.tied
    if job.kind != HELD or _may_go_on(floor, job):
        send(floor, worker, job.station, job)
        return True
    _untie_from(floor, worker)
    if job.station.down:
        go_on(floor, job)
    return True


@inlined
def _may_go_on(floor: Floor, job: Job) -> bool:
    """Whether its station is up, and the tools are there that go with the worker."""
    if job.station.down:
        return False
    return job.setup_task >= 0 or is_ready(floor, job.station, job)


@step
def met(floor: Floor, job: Job, worker: Worker) -> bool:
    """He has come to a job; True where he has nothing to do there but to wait until he can carry it."""
    if worker.tied is not job:
        return False
    _untie_from(floor, worker)
    if job.kind == HELD:
        return False
    worker.since_s = floor.now  # what he did until now is written
    hold(floor, worker, job)
    want_in(floor, job, floor.now)
    return True


def hang(build: Any) -> None:
    """Ties of a floor hang in."""
    build.hang(build.floor.left_station, untie)
    build.hang(build.floor.lost_server, untie)
