"""Conveyors that do not accumulate: while the job at the end cannot get off, all of them stand still."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.boarding import forget_opening, hang
from opsim.engine.floor.machine import Handle, cast, index_of, inlined, line_of, step
from opsim.engine.floor.material import operation_done
from opsim.engine.floor.parts.belts import Belt, moved_at_s, rest_s
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.rules import COMPLETION
from opsim.log import QUEUE, TRANSPORT

_as_belt = cast(Belt)


@step
def get_on(floor: Floor, belt: Belt, job: Job) -> None:
    """A job gets on."""
    belt.on_at_s.append(moved_at_s(belt, floor.now))
    belt.jobs.append(job)
    job_now(floor, job, QUEUE if belt.halted else TRANSPORT, 0)
    if len(belt.jobs) == 1:
        _first_rides(floor, belt)


@step
def get_off(floor: Floor, belt: Belt, job: Job) -> None:
    """The first job is gone, and the belt moves on."""
    at = index_of(belt.jobs, job)
    del belt.jobs[at]
    del belt.on_at_s[at]
    belt.stands, belt.since_s = 0, floor.now
    if belt.halted:
        belt.halted = 0
        for other in belt.jobs:
            job_now(floor, other, TRANSPORT, 0)
    if belt.jobs:
        _first_rides(floor, belt)


@inlined
def _first_rides(floor: Floor, belt: Belt) -> None:
    left_s = rest_s(belt, 0, belt.travel_s, floor.now)
    alarm(floor, left_s, COMPLETION, belt.rank, belt.jobs[0].number, line_of_at_end, belt)


@step
def at_end(floor: Floor, event: Event) -> None:
    """The belt stands from now on, unless the first job gets off at once."""
    belt: Belt = _as_belt(event.subject)
    belt.moved_s = moved_at_s(belt, floor.now)
    belt.stands = 1
    forget_opening(floor, belt)
    operation_done(floor, belt.jobs[0])


@step
def halt(floor: Floor, belt: Belt) -> bool:
    """The rows of jobs on a belt that came to stand say so."""
    if belt.stands and not belt.halted:
        belt.halted = 1
        for i in range(1, len(belt.jobs)):
            job_now(floor, belt.jobs[i], QUEUE, 0)
    return False


line_of_at_end = line_of(at_end)


def install(build: Any, belts: list[Handle]) -> None:
    """Jobs that come to such a conveyor get on, and who leaves it gets off."""
    for belt in belts:
        belt.rigid = 1
        hang(build, belt, get_on, get_off)
        build.line(at_end)
        build.hang(build.floor.dispatchers, halt, belt)
