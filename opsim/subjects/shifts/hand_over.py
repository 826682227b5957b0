"""Hand-over: who has to go works on until somebody free has come and takes over.

Jobs that wait for one worker: for him who began the task, or who has to carry them.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import CREWS, Floor
from opsim.engine.floor.keys import is_better, keep_best, pair_key
from opsim.engine.floor.machine import NOTHING, fresh, inlined, step
from opsim.engine.floor.settle import is_fetched
from opsim.engine.floor.state import Job, Station, Worker
from opsim.engine.rules import first_relief
from opsim.log import HELD, SETUP, WORK
from opsim.subjects.people.allocation import PATROL, send
from opsim.subjects.people.worker import hold, is_ready, may_serve, on_round, set_free
from opsim.subjects.routes.routing import claim_at, give_up_claims, may_enter, put_claim, take_claim, want_in
from opsim.subjects.shifts.interruption import take_over
from opsim.subjects.shifts.shifts import People, Relief
from opsim.subjects.stations.station import go_on

ORDER = 40
"""Among the ways to begin a task: after the way along a moving line, so that he takes over where the job is."""
_new_relief = fresh(Relief)
_first_relief = inlined(first_relief)


@inlined
def _may_begin(relief: Relief, now: float) -> bool:
    """Whether there is something to take over: he is at work, and is not done at this very instant."""
    job = relief.job
    at_work = job.worker == relief.leaver.rank and relief.leaver.job is job and (job.kind == WORK or job.kind == SETUP)
    return at_work and job.since_s + job.duration_s > now


@step
def ask(floor: Floor, leaver: Worker, job: Job) -> None:
    """Somebody is wanted. NOTE: it is forgotten when nobody refers to it any more, which is not looked after."""
    relief: Relief = _new_relief(floor)
    relief.leaver, relief.job, relief.since_s = leaver, job, floor.now
    if not floor.people.asked[leaver.rank]:
        floor.people.n_asked += 1
    floor.people.asked[leaver.rank] = relief


@step
def be_wanted_no_more(floor: Floor, leaver: Worker) -> None:
    """Nobody is wanted any more; who is on his way comes all the same, and is free there."""
    people = floor.people
    if not people.asked[leaver.rank]:
        return
    relief = people.asked[leaver.rank]
    people.asked[leaver.rank] = people.no_relief
    people.n_asked -= 1
    if relief.taker:
        _stop_coming(people, relief.taker)
        if relief.taker.job is relief.job:  # else he was stopped on his way along a moving line
            relief.taker.job = NOTHING


@inlined
def _stop_coming(people: People, taker: Worker) -> None:
    if people.coming[taker.rank]:
        people.coming[taker.rank] = people.no_relief
        people.n_coming -= 1


@step
def job_gone(floor: Floor, people: People, job: Job, station: Station) -> None:
    """The job has left its station."""
    if not people.n_asked:
        return
    for rank in range(floor.n_workers):
        if people.asked[rank] and people.asked[rank].job is job:
            be_wanted_no_more(floor, floor.workers[rank])


@step
def turns_back(floor: Floor, taker: Worker) -> bool:
    """Who was on his way has to go himself, and another one is wanted; False where he was not."""
    people = floor.people
    relief = people.coming[taker.rank]
    if not relief:
        return False
    _stop_coming(people, taker)
    relief.taker = NOTHING
    taker.job = NOTHING
    return True


@step
def send_takers(floor: Floor) -> bool:
    """Send who is free and can do it, by the rule of allocation; True where somebody goes."""
    people, sent = floor.people, False
    _put_in_turn(floor, people)
    for relief in people.in_turn:
        if relief.leaver.job is not relief.job:
            be_wanted_no_more(floor, relief.leaver)
        elif not relief.taker and _may_begin(relief, floor.now):
            taker = best_free(floor, relief.job.station, relief.job, relief.since_s, False)
            if taker:
                relief.taker = taker
                people.coming[taker.rank] = relief
                people.n_coming += 1
                send(floor, taker, relief.job.station, relief.job)
                sent = True
    return sent


@inlined
def _put_in_turn(floor: Floor, people: People) -> None:
    people.in_turn.clear()
    for rank in range(floor.n_workers):
        relief = people.asked[rank]
        if relief:
            at = len(people.in_turn)
            while at > 0 and _is_before(relief, people.in_turn[at - 1]):
                at -= 1
            people.in_turn.insert(at, relief)


@inlined
def _is_before(one: Relief, other: Relief) -> bool:
    return _first_relief(one.since_s, one.leaver.rank) < _first_relief(other.since_s, other.leaver.rank)


@step
def met(floor: Floor, people: People, job: Job, worker: Worker) -> bool:
    """Somebody has come to take over, and does, or there is nothing left to take over; False where he had not."""
    if not people.n_coming:
        return False
    relief = people.coming[worker.rank]
    if not relief:
        return False
    _stop_coming(people, worker)
    relief.taker = NOTHING
    if relief.job is not job:  # he was stopped on his way along a moving line, and sent elsewhere
        return False
    worker.since_s = floor.now  # what he did until now is written
    if _may_begin(relief, floor.now):
        people.asked[relief.leaver.rank] = people.no_relief
        people.n_asked -= 1
        take_over(floor, job, worker)
    else:
        set_free(floor, worker)
    return True


@step
def best_free(floor: Floor, station: Station, job: Job, since_s: float, to_carry: bool) -> Worker:
    """Who of the free comes to a job, by the rule of allocation, or nobody.

    On patrol, only who stands at the station: at a stop of his round, or ``to_carry`` it wherever he is on it.
    """
    best, n_waiting, n_able = floor.no_worker, float(1 + len(station.queue)), 0
    for worker in floor.free:
        if not may_serve(worker, station):
            continue
        if floor.idle == PATROL and not (_passes(worker, station) if to_carry else on_round(worker, station)):
            continue
        n_able += 1
        pair_key(floor, worker, station, job, n_waiting, since_s)
        if n_able == 1 or is_better(floor):
            best = worker
            keep_best(floor)
    return best


@inlined
def _passes(worker: Worker, station: Station) -> bool:
    """Whether he stands at a station of his round."""
    if worker.place != station.place:
        return False
    for i in range(worker.n_patrol):
        if worker.patrol[i] == station.rank:
            return True
    return False


def hang_relief(build: Any, people: Any) -> None:
    """Reliefs of a floor hang in."""
    people.asked = build.ints([0] * len(build.workers))
    people.coming = build.ints([0] * len(build.workers))
    build.hang(build.floor.left_station, job_gone, people)
    for station in build.stations:
        build.hang(station.acts, met, people, ORDER)


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
def meets_tied_job(floor: Floor, job: Job, worker: Worker) -> bool:
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


def hang_ties(build: Any) -> None:
    """Ties of a floor hang in."""
    build.hang(build.floor.left_station, untie)
    build.hang(build.floor.lost_server, untie)
