"""Crews: bucket brigades and rabbit chases, whose members go with their jobs along a line.

Who takes which job, who goes back for which, and who waits behind whom; a job passes from one member to another,
whatever it is doing at the moment.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.floor_state import CREWS, DUTY, Floor
from opsim.engine.floor.flow import move_on
from opsim.engine.floor.log_rows import job_now, log_worker
from opsim.engine.floor.machine import NOTHING, Handle, drop, inlined, step
from opsim.engine.floor.settle import is_fetched
from opsim.engine.floor.state import Job, Worker
from opsim.engine.rules import FINISH, FINISH_JOB, RESTART
from opsim.log import (
    AFTER,
    AWAY,
    BEHIND,
    BLOCKED,
    HELD,
    IDLE,
    JOB_BLOCKED,
    NO_WORKER,
    SETUP,
    TRANSPORT,
    WAIT,
    WALK,
    WORK,
)
from opsim.subjects.lines import crew_lines
from opsim.subjects.lines.crew_lines import (
    Crew,
    comer_to,
    comes_soon,
    goes_to,
    holder_of,
    is_stuck,
    let_go,
    may_leave,
    number_ahead,
    place_of,
    reaches,
    tidy_line,
    tidy_people,
)
from opsim.subjects.lines.plan import BUCKET_BRIGADE, CrewPlan
from opsim.subjects.people.allocation import send
from opsim.subjects.people.worker import be_busy, hold, set_free, walk_time_s
from opsim.subjects.routes.routing import claim_at, give_up_claims, put_claim, stir_gate
from opsim.subjects.shifts.interruption import take_over
from opsim.subjects.stations.station import go_on


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


_takes_over, _takes_up = inlined(rules.takes_over), inlined(rules.takes_up)


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
    turn, near = crew.turn, crew.near
    for member in range(crew.n_members):
        worker = crew.members[member]
        walk_s = walk_time_s(floor, worker, crew.stations[0])
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


COMES, DONE = -10, 90
"""Among the preparations of a job the first; among what is asked when an operation is done the last."""


def install(build: Any) -> None:
    """The members of each crew are sent by it; that nobody else serves its stations is in their ratings."""
    if not build.plan.crews:
        return
    build.keep_jobs()
    crews = [_crew(build, plan) for plan in build.plan.crews]
    for rank in {rank for plan in build.plan.crews for rank in plan.workers}:
        build.restrict(build.workers[rank], CREWS, ())
    for number, (crew, plan) in enumerate(zip(crews, build.plan.crews)):
        for rank in plan.stations:
            build.hang(build.stations[rank].stages, crew_lines.came, crew, COMES)
            build.hang(build.stations[rank].afters, done, crew, DONE)
        _guard(build, crew, plan, number)
        build.hang(build.floor.dispatchers, dispatch, crew)


def _crew(build: Any, plan: CrewPlan) -> Handle:
    crew, n = build.arena.new("Crew"), len(plan.workers)
    crew.is_brigade = plan.kind == BUCKET_BRIGADE
    crew.n_stations = len(plan.stations)
    crew.stations = build.arena.array("Station", [build.stations[rank] for rank in plan.stations])
    places = {rank: place for place, rank in enumerate(plan.stations)}
    crew.place = build.ints(places.get(rank, -1) for rank in range(len(build.stations)))
    gates = [gate for ranks, gate in build.gates.items() if not places.keys().isdisjoint(ranks)]
    crew.n_gates, crew.gates = len(gates), build.arena.array("Gate", gates)
    crew.n_members = n
    crew.members = build.arena.array("Worker", [build.workers[rank] for rank in plan.workers])
    crew.hand, crew.goal, crew.turn = build.ints([0] * n), build.ints([0] * n), build.ints([0] * n)
    crew.stand, crew.near = build.ints([-1] * n), build.floats([0.0] * n)
    return crew


def _guard(build: Any, crew: Handle, plan: CrewPlan, number: int) -> None:
    """Have every gate into the line keep the order too, where jobs may skip stations."""
    for ranks, gate in build.gates.items():
        first = min((place for place, rank in enumerate(plan.stations) if rank in ranks), default=-1)
        if first >= 0:
            guard = build.arena.new("CrewGate")
            guard.crew, guard.gate, guard.first_place = crew, gate, first
            build.hang(gate.allows, crew_lines.stays_behind, guard, -1 - number)
            if gate.pick:
                guard.picked = gate.pick
                gate.pick = build.hook(crew_lines.first_behind, guard)
    build.hang(build.floor.left_station, crew_lines.stir_line, crew)
