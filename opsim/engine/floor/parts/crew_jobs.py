"""Jobs of a crew's line: where they are, who has them, and who is ahead of them."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, inlined
from opsim.engine.floor.parts.crews import Crew
from opsim.engine.floor.parts.state import Job
from opsim.log import AFTER, BLOCKED, HELD, NO_PLACE, QUEUE


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
