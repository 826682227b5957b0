"""The line of a crew: its jobs in their order, in which none overtakes another; who has them, and who is ahead."""

from __future__ import annotations

from opsim.engine import rules
from opsim.engine.floor.floor_state import DUTY, Floor
from opsim.engine.floor.log_rows import log_worker
from opsim.engine.floor.machine import NOTHING, Array, List, inlined, step, struct
from opsim.engine.floor.records import Hook
from opsim.engine.floor.state import Gate, Job, Station, Worker
from opsim.log import ABSENT, AFTER, BLOCKED, BREAK, HELD, NO_PLACE, OFF, QUEUE, TRANSPORT, WALK
from opsim.subjects.people.worker import be_busy, walk, walk_time_s
from opsim.subjects.routes.routing import may_enter, stir_gate


@struct
class Crew:
    """A bucket brigade, or a rabbit chase.

    jobs, carried, gates : of its line; place : by the rank of a station, where in the line it is, -1: elsewhere
    hand, goal, stand : by the number of a member; of ``stand`` -1: he comes from elsewhere
    turn, near : members in the order in which they are asked, and what they are sorted by
    done_here : jobs that are done at a station and wait there; going : those of them that go on just now
    holders : of each job of the line, who has it, or comes for it
    """

    is_brigade: int
    n_stations: int
    stations: Array[Station]
    place: Array[int]
    n_gates: int
    gates: Array[Gate]
    jobs: List[Job]
    carried: List[int]
    carried_now: List[int]
    n_members: int
    members: Array[Worker]
    hand: Array[Job]
    goal: Array[Job]
    stand: Array[int]
    turn: Array[int]
    near: Array[float]
    done_here: List[Job]
    going: List[Job]
    holders: List[int]


@struct
class CrewGate:
    """A gate into the line of a crew. first_place : the first of its stations in the line; picked : what picks else."""

    crew: Crew
    gate: Gate
    first_place: int
    picked: Hook


@inlined
def place_of(crew: Crew, job: Job) -> int:
    """Where in the line a job is: the number of its station; -1: elsewhere."""
    rank = job.station.rank
    return crew.place[rank] if rank >= 0 else -1


@inlined
def number_ahead(crew: Crew, job: Job) -> int:
    """The number of the job that is next ahead of one in the line; -1 where there is none, or the job is not in it."""
    before = -1
    for number in range(len(crew.jobs)):
        other = crew.jobs[number]
        if other is job:
            return before
        if other.on_floor and place_of(crew, other) >= 0:
            before = number
    return -1


@inlined
def may_leave(crew: Crew, job: Job) -> bool:
    """Whether a job that is done at a station leaves nobody there who was ahead of it, and is not done."""
    number = number_ahead(crew, job)
    if number < 0:
        return True
    ahead = crew.jobs[number]
    if place_of(crew, ahead) > place_of(crew, job):
        return True
    return ahead.kind == BLOCKED or (ahead.kind == QUEUE and ahead.cause == AFTER)


@inlined
def is_stuck(crew: Crew, job: Job) -> bool:
    """Whether a job waits for room, for a server, or for who is ahead of it."""
    waits_for_place = job.kind == HELD and job.cause == NO_PLACE
    return job.kind == BLOCKED or job.kind == QUEUE or waits_for_place or job in crew.done_here


@inlined
def holder_of(crew: Crew, job: Job) -> int:
    """Who has a job; -1: nobody."""
    for member in range(crew.n_members):
        if crew.hand[member] is job:
            return member
    return -1


@inlined
def comer_to(crew: Crew, job: Job) -> int:
    """The last member who is on his way to a job; -1: nobody is."""
    for member in range(crew.n_members - 1, -1, -1):
        if crew.goal[member] is job:
            return member
    return -1


@inlined
def comes_soon(crew: Crew, job: Job, after: int) -> bool:
    """Whether somebody is on his last way to a job, or waits there for it, of those who come after a member."""
    for member in range(after + 1, crew.n_members):
        if crew.goal[member] is job and crew.members[member].place == job.station.place:
            return True
    return False


@inlined
def let_go(crew: Crew, job: Job) -> None:
    """Nobody has the job any more."""
    for member in range(crew.n_members):
        if crew.hand[member] is job:
            crew.hand[member] = NOTHING


_overtakes = inlined(rules.overtakes)


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


@step
def tidy_people(floor: Floor, crew: Crew) -> None:
    """Jobs that have left the line are in nobody's hands; who is away has let go of his."""
    for member in range(crew.n_members):
        away = _is_away(crew.members[member])
        if away or crew.hand[member] not in crew.jobs:
            crew.hand[member] = NOTHING
        if away or crew.goal[member] not in crew.jobs:
            crew.goal[member] = NOTHING
        if away:
            crew.stand[member] = -1


@step
def reaches(floor: Floor, crew: Crew, member: int, job: Job, place: int) -> bool:
    """Whether a free member stands where a job is; else he goes there, or a part of the way."""
    if goes_to(floor, crew, member, place):
        return True
    crew.goal[member] = job
    return False


@step
def goes_to(floor: Floor, crew: Crew, member: int, place: int) -> bool:
    """Whether a free member is at a station of the line; else he sets out, along it only as far as the next one."""
    worker = crew.members[member]
    at = crew.stand[member]
    while worker.place != crew.stations[place].place or at != place:
        if at < 0 or not crew.is_brigade:
            at = place
        else:
            at += 1 if place > at else -1 if place < at else 0
        station = crew.stations[at]
        crew.stand[member] = at
        walk_s = walk_time_s(floor, worker, station)
        if walk_s > 0:
            log_worker(floor, worker)
            be_busy(floor, worker)
            walk(floor, worker, station.place, walk_s)
            return False
        worker.place = station.place
    return True


@inlined
def _is_away(worker: Worker) -> bool:
    """Whether somebody is off, absent or resting, or walks and will be: only what he carries is still his."""
    if worker.kind == WALK:
        return not worker.job and worker.limited[DUTY] == 1
    away = worker.kind == BREAK or worker.kind == OFF or worker.kind == ABSENT
    return away and worker.in_free == 0
