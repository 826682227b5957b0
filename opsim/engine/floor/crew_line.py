"""The line of a crew: its jobs in their order, in which none overtakes another."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.crew_jobs import number_ahead, place_of
from opsim.engine.floor.parts.crews import Crew, CrewGate
from opsim.engine.floor.parts.events import stir_gate
from opsim.engine.floor.parts.gates import may_enter
from opsim.engine.floor.parts.state import Floor, Gate, Job, Station
from opsim.engine.rules import crews
from opsim.log import AFTER, QUEUE, TRANSPORT

_overtakes = inlined(crews.overtakes)


@step
def came(floor: Floor, crew: Crew, job: Job) -> bool:
    """The job has a server: a preparation that is done at once. Who is new is behind all that are as far on."""
    if job not in crew.jobs:
        crew.jobs.append(job)
    tidy_line(floor, crew)
    return True


@step
def tidy_line(floor: Floor, crew: Crew) -> None:
    """Jobs that have left the line are in it no more. Who has a server is ahead of who is on his way to one there.

    Else jobs keep their order, unless one comes again from the start, or a queue has let it go first.
    """
    crew.carried_now.clear()
    at = 0
    while at < len(crew.jobs):
        job = crew.jobs[at]
        if not job.on_floor or place_of(crew, job) < 0:
            del crew.jobs[at]
            continue
        if job.kind == TRANSPORT and job.plan.carried:
            crew.carried_now.append(job.number)
        at += 1
    _sort(crew)
    for one in crew.carried:
        if one not in crew.carried_now:  # somebody has come: who is behind him may set out
            _stir_all(floor, crew)
    crew.carried.clear()
    for other in crew.carried_now:
        crew.carried.append(other)


@inlined
def _comes(job: Job) -> bool:
    """Whether a job is on its way to a server, or waits for one."""
    return job.kind == TRANSPORT or (job.kind == QUEUE and job.cause != AFTER)


@inlined
def _is_first(crew: Crew, job: Job, other: Job) -> bool:
    mine, others = place_of(crew, job), place_of(crew, other)
    return mine > others or (mine == others and not _comes(job) and _comes(other))


@inlined
def _sort(crew: Crew) -> None:
    jobs = crew.jobs
    for i in range(1, len(jobs)):
        job, at = jobs[i], i
        while at > 0 and _is_first(crew, job, jobs[at - 1]):
            jobs[at] = jobs[at - 1]
            at -= 1
        jobs[at] = job


@inlined
def _stir_all(floor: Floor, crew: Crew) -> None:
    for i in range(crew.n_gates):
        if crew.gates[i].claims:
            stir_gate(floor, crew.gates[i])


@step
def stir_line(floor: Floor, crew: Crew, job: Job, station: Station) -> None:
    """Who was behind a job that goes on may go on too."""
    if crew.place[station.rank] >= 0:
        _stir_all(floor, crew)


@step
def stays_behind(floor: Floor, guard: CrewGate, job: Job) -> bool:
    """Whether a job that comes in by a gate stays behind the one ahead of it, which may still be carried there."""
    crew = guard.crew
    number = number_ahead(crew, job)
    if number < 0:
        return True
    ahead = crew.jobs[number]
    on_its_way = ahead.kind == TRANSPORT and ahead.plan.carried == 1
    return not _overtakes(guard.first_place + (1 if on_its_way else 0), place_of(crew, ahead))


@step
def first_behind(floor: Floor, guard: CrewGate, gate: Gate) -> int:
    """Cards go by lines of their own: where who they pick has to stay behind, the next one who need not."""
    number = guard.picked.line(floor, guard.picked.subject, gate)
    if number < 0 or stays_behind(floor, guard, gate.claims[number].job):
        return number
    for other in range(len(gate.claims)):
        if may_enter(floor, gate, gate.claims[other].job):
            return other
    return -1
