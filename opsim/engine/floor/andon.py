"""Andon: somebody is called to a job of a paced line that is not done in time; he takes over, or helps."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.allocation import send
from opsim.engine.floor.helping import begin_helping, can_help, hang_helping
from opsim.engine.floor.interruption import take_over
from opsim.engine.floor.machine import NOTHING, Handle, inlined, step
from opsim.engine.floor.parts.bits import may_serve
from opsim.engine.floor.parts.claims import claim_at, give_up_claims, put_claim, take_claim
from opsim.engine.floor.parts.keys import is_better, keep_best, pair_key
from opsim.engine.floor.parts.line_clocks import is_open
from opsim.engine.floor.parts.lines import Andon
from opsim.engine.floor.parts.performing import task_of
from opsim.engine.floor.parts.state import LINES, Floor, Job, Station, Worker
from opsim.engine.floor.sent_on import tell_lost_server, turn_away
from opsim.engine.floor.station import go_on
from opsim.engine.floor.worker import set_free
from opsim.log import AWAY, HELD, NO_WORKER, SETUP, WORK
from opsim.plan import LinePlan

ORDER = 5
"""Among the ways to begin a task: the first, since who comes to a job that somebody is at begins none."""


@step
def call_for(floor: Floor, andon: Andon, job: Job) -> None:
    """Somebody is wanted at a job."""
    put_claim(floor, andon.waiting, job, floor.now)


@step
def nobody_wanted(floor: Floor, andon: Andon, job: Job) -> None:
    """The job is done, or sent on: nobody is wanted, and who is on his way comes all the same."""
    give_up_claims(floor, andon.waiting, job)
    for number in range(andon.n_floaters):
        worker = andon.floaters[number]
        if andon.coming[number] is job:
            _comes_no_more(andon, number)
            if worker.job is job:
                worker.job = NOTHING
                worker.station = NOTHING


@inlined
def _comes_no_more(andon: Andon, number: int) -> None:
    andon.coming[number] = NOTHING
    andon.floaters[number].called_by = NOTHING


@step
def send_called(floor: Floor, andon: Andon) -> bool:
    """Send who is free to the jobs that have waited longest; True where somebody goes."""
    andon.asked.clear()
    for claim in andon.waiting:
        andon.asked.append(claim.job)
    sent = False
    for one in andon.asked:
        if _send_to(floor, andon, one):
            sent = True
    return sent


@step
def _send_to(floor: Floor, andon: Andon, job: Job) -> bool:
    if claim_at(andon.waiting, job) < 0:
        return False
    if not is_open(andon.line, job):
        take_claim(floor, andon.waiting, claim_at(andon.waiting, job))
        return False
    number = _best(floor, andon, job)
    if number < 0:
        return False
    if _others_first(floor, andon, job):
        return True
    if not _can_be_taken(floor, job):
        return False
    take_claim(floor, andon.waiting, claim_at(andon.waiting, job))
    worker = andon.floaters[number]
    andon.coming[number], worker.called_by = job, andon
    send(floor, worker, job.station, job)
    return True


@step
def _best(floor: Floor, andon: Andon, job: Job) -> int:
    """The number of the best of those who are free and may go, by the rule of allocation; -1: nobody is."""
    best = -1
    for number in range(andon.n_floaters):
        worker = andon.floaters[number]
        if worker.in_free and _may(floor, worker, job.station):
            pair_key(floor, worker, job.station, job, 1, job.since_s)
            if best < 0 or is_better(floor):
                best = number
                keep_best(floor)
    return best


@step
def _others_first(floor: Floor, andon: Andon, job: Job) -> bool:
    """Whether whoever works here all the time is free for the job, and may be sent in this instant."""
    if andon.left_s == floor.now or claim_at(job.station.calling, job) < 0:
        return False
    for worker in floor.free:
        if may_serve(worker, job.station):
            andon.left_s = floor.now
            return True
    return False


@step
def act(floor: Floor, andon: Andon, job: Job, worker: Worker) -> bool:
    """Somebody who was called is there, or at the beginning of the stretch: he does what he was called for."""
    number = _number_of(andon, worker)
    if number < 0 or andon.coming[number] is not job:
        return False
    line = andon.line
    if line.act_line and line.act_line(floor, line, job, worker):
        return True
    _comes_no_more(andon, number)
    worker.since_s = floor.now
    if not (_may(floor, worker, job.station) and _can_be_taken(floor, job)):
        set_free(floor, worker)
        call_for(floor, andon, job)
    elif line.helps and can_help(floor, job):
        begin_helping(floor, job, worker)
        call_for(floor, andon, job)  # for the tasks that follow
    else:
        _take(floor, andon, job, worker)
    return True


@inlined
def _number_of(andon: Andon, worker: Worker) -> int:
    if worker.called_by:
        for number in range(andon.n_floaters):
            if andon.floaters[number] is worker:
                return number
    return -1


@step
def turns_back(floor: Floor, andon: Andon, worker: Worker, job: Job) -> None:
    """Somebody on his way, who was called, has to go: the job calls for others, where nobody is at it or comes."""
    _comes_no_more(andon, _number_of(andon, worker))
    worker.job = NOTHING
    call_for(floor, andon, job)
    if job.kind != HELD or job.cause != NO_WORKER or claim_at(job.station.calling, job) >= 0:
        return
    for rank in range(floor.n_workers):
        if floor.workers[rank].job is job:
            return
    go_on(floor, job)


@inlined
def _take(floor: Floor, andon: Andon, job: Job, worker: Worker) -> None:
    if job.kind == HELD:
        if andon.line.stop_walks_line:
            andon.line.stop_walks_line(floor, andon.line, job, worker.rank)
        turn_away(floor, job, worker.rank)
        if job.cause == AWAY:
            tell_lost_server(floor, job)
    take_over(floor, job, worker)


@inlined
def _may(floor: Floor, worker: Worker, station: Station) -> bool:
    """Whether somebody who is called may go to a station: he has the skill, and no other block keeps him."""
    if worker.rating[station.rank] <= 0:
        return False
    for limit in range(floor.n_limits):
        if limit != LINES and worker.limited[limit]:
            at = limit * floor.n_words + (station.rank >> 6)
            if not (worker.limits[at] >> (station.rank & 63)) & 1:
                return False
    return True


@inlined
def _can_be_taken(floor: Floor, job: Job) -> bool:
    """Whether one worker alone is at the job and is not being helped, or nobody is and somebody is wanted."""
    if job.has_team:
        return False
    if job.kind == WORK or job.kind == SETUP:  # else who is at it is done in this very instant
        return job.worker >= 0 and job.since_s + job.duration_s > floor.now
    if job.station.down or job.kind != HELD or (job.cause != NO_WORKER and job.cause != AWAY):
        return False
    return floor.tasks[task_of(job)].team == 1


def hang_andon(build: Any, plan: LinePlan, line: Handle) -> Handle:
    """Call somebody to the jobs of a line; he is sent nowhere else on it."""
    andon, floaters = build.arena.new("Andon"), [build.workers[rank] for rank in plan.floaters]
    andon.line, andon.left_s = line, -1.0
    andon.n_floaters, andon.floaters = len(floaters), build.arena.array("Worker", floaters)
    andon.coming = build.ints([0] * len(floaters))
    if plan.helps:
        hang_helping(build, plan.stations)
    for rank in plan.stations:
        build.hang(build.stations[rank].acts, act, andon, ORDER)
    for worker in floaters:
        build.restrict(worker, LINES, _left_to(build, worker) - set(plan.stations))
    build.hang(build.floor.dispatchers, send_called, andon)
    return andon


def _left_to(build: Any, worker: Handle) -> set[int]:
    """The stations that other lines leave him, by their ranks."""
    everywhere = set(range(len(build.stations)))
    if not worker.limited[LINES]:
        return everywhere
    words = worker.limits
    at = LINES * build.floor.n_words
    return {rank for rank in everywhere if words[at + (rank >> 6)] >> (rank & 63) & 1}
