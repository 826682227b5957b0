"""A crew: who takes which job, who goes back for which, and who waits behind whom."""

from __future__ import annotations

from opsim.engine.floor.allocation import send
from opsim.engine.floor.crew_hands import (
    caught_up,
    must_stay,
    put_down,
    stands_behind,
    stays_with,
    takes_on,
    waits,
)
from opsim.engine.floor.crew_line import tidy_line
from opsim.engine.floor.crew_people import goes_to, reaches, tidy_people
from opsim.engine.floor.machine import NOTHING, drop, inlined, step
from opsim.engine.floor.material import move_on
from opsim.engine.floor.parts.claims import claim_at
from opsim.engine.floor.parts.crew_jobs import (
    comer_to,
    comes_soon,
    holder_of,
    is_stuck,
    let_go,
    may_leave,
    number_ahead,
    place_of,
)
from opsim.engine.floor.parts.crews import Crew
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import DUTY, Floor, Job, Worker
from opsim.engine.rules import crews
from opsim.log import BEHIND, HELD, IDLE, NO_WORKER

_takes_over, _takes_up = inlined(crews.takes_over), inlined(crews.takes_up)


@step
def done(floor: Floor, crew: Crew, job: Job) -> bool:
    """Whether a job that is done at a station leaves it: nobody ahead of it is still there, or comes to take it."""
    comes = comes_soon(crew, job, -1)
    if not comes and may_leave(crew, job):
        return True
    job_now(floor, job, HELD, NO_WORKER if comes else BEHIND)
    crew.done_here.append(job)
    if comes:
        let_go(crew, job)
    return False


@step
def dispatch(floor: Floor, crew: Crew) -> bool:
    """Everybody who is free goes on with his job, takes one, or goes to where he may find one."""
    tidy_line(floor, crew)
    tidy_people(floor, crew)
    at = 0
    while at < len(crew.done_here):
        if crew.done_here[at] in crew.jobs:
            at += 1
        else:
            del crew.done_here[at]
    changed = _let_on(floor, crew)
    _set_turn(floor, crew)
    for i in range(crew.n_members):
        worker = crew.members[crew.turn[i]]
        if not worker.limited[DUTY] and _next(floor, crew, crew.turn[i], worker):
            changed = True
        stands_behind(floor, crew, worker)
    return changed


@inlined
def _set_turn(floor: Floor, crew: Crew) -> None:
    """Members in the order in which they are asked: the last of a brigade first; else who is nearest the start."""
    first, turn, near = crew.stations[0].rank, crew.turn, crew.near
    for member in range(crew.n_members):
        worker = crew.members[member]
        walk_s = worker.walk_s[worker.place * floor.n_stations + first]
        near[member] = -float(member) if crew.is_brigade else walk_s
        at = member
        while at > 0 and near[member] < near[turn[at - 1]]:
            turn[at] = turn[at - 1]
            at -= 1
        turn[at] = member


@step
def _let_on(floor: Floor, crew: Crew) -> bool:
    """Jobs that are done at their station go on, where nobody is in their way any more."""
    crew.going.clear()
    for job in crew.done_here:
        if comer_to(crew, job) < 0 and may_leave(crew, job):
            crew.going.append(job)
    for one in crew.going:
        drop(crew.done_here, one)
        move_on(floor, one)
    return len(crew.going) > 0


@step
def _next(floor: Floor, crew: Crew, member: int, worker: Worker) -> bool:
    """What a member does next, where he is free or only waits. True where something changed."""
    job = crew.hand[member]
    if job and _waits_for_nobody(crew, job):
        put_down(floor, job)
        crew.hand[member] = NOTHING
        job = crew.hand[member]
    if not worker.in_free:
        return False
    crew.goal[member] = NOTHING
    if job:
        return _goes_on(floor, crew, member, worker, job)
    return _looks(floor, crew, member, worker)


@inlined
def _waits_for_nobody(crew: Crew, job: Job) -> bool:
    """Whether a job waits for one that nobody sees to: who has it does better to see to that himself."""
    if not is_stuck(crew, job):
        return False
    number = number_ahead(crew, job)
    return number >= 0 and holder_of(crew, crew.jobs[number]) < 0 and comer_to(crew, crew.jobs[number]) < 0


@step
def _looks(floor: Floor, crew: Crew, member: int, worker: Worker) -> bool:
    """A member without a job takes one where he meets it, or goes there. True where something changed."""
    number = _wanted(floor, crew, member)
    if number < 0:
        _to_the_start(floor, crew, member, worker)
        return False
    job = crew.jobs[number]
    if not reaches(floor, crew, member, job, place_of(crew, job)):
        return False
    if not caught_up(floor, job):
        waits(floor, worker, BEHIND)
        crew.goal[member] = job
        return False
    let_go(crew, job)
    crew.hand[member] = job
    takes_on(floor, worker, job)
    if worker.in_free:
        _goes_on(floor, crew, member, worker, job)
    return True


@step
def _goes_on(floor: Floor, crew: Crew, member: int, worker: Worker, job: Job) -> bool:
    """Somebody with a job in his hands is sent to it where it calls; else he stays by it and waits."""
    if comes_soon(crew, job, member):
        let_go(crew, job)
        return True
    if claim_at(job.station.calling, job) >= 0:
        crew.stand[member] = place_of(crew, job)
        send(floor, worker, job.station, job)
        return True
    if must_stay(floor, job):
        if reaches(floor, crew, member, job, place_of(crew, job)):
            stays_with(floor, worker, job)
            return True
        return False
    waits(floor, worker, BEHIND if is_stuck(crew, job) else IDLE)
    return False


@step
def _wanted(floor: Floor, crew: Crew, member: int) -> int:
    """The job that a member without one goes for, by its number: of those he may have, the one that is furthest on.

    -1: there is none.
    """
    holders, behind = crew.holders, 0
    holders.clear()
    for number in range(len(crew.jobs)):
        job = crew.jobs[number]
        holders.append(max(holder_of(crew, job), comer_to(crew, job)))
        if crew.is_brigade and holders[number] > member:
            behind = number + 1
    for number in range(behind, len(crew.jobs)):
        mine = _takes_over(member, holders[number]) if crew.is_brigade else _takes_up(member, holders[number])
        if mine:
            return number
    return -1


@step
def _to_the_start(floor: Floor, crew: Crew, member: int, worker: Worker) -> None:
    """Who finds nothing to do goes to the first station, and waits there for a job, or for a free server."""
    if not goes_to(floor, crew, member, 0):
        return
    first = crew.stations[0]
    wanted = len(first.queue) > 0 or len(floor.saturated) > 0
    for i in range(first.n_wanted_by):
        if first.wanted_by[i].claims:
            wanted = True
    waits(floor, worker, BEHIND if wanted and not first.free_servers else IDLE)
