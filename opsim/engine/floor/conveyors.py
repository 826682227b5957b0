"""Accumulating conveyors: each job rides on until it stands behind another one."""

from __future__ import annotations

from math import inf
from typing import Any

from opsim.engine.floor import rigid_conveyors
from opsim.engine.floor.boarding import hang
from opsim.engine.floor.machine import Call, Handle, cast, drop, inlined, line_of, step
from opsim.engine.floor.material import operation_done
from opsim.engine.floor.parts.belts import Belt
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.rules import COMPLETION
from opsim.log import QUEUE, TRANSPORT

_as_belt = cast(Belt)


@step
def get_on(floor: Floor, belt: Belt, job: Job) -> None:
    """A job gets on, and rides."""
    belt.jobs.append(job)
    belt.last_on_s = floor.now
    job_now(floor, job, TRANSPORT, 0)
    _later(floor, belt, job, belt.travel_s, line_of_ridden)


@step
def get_off(floor: Floor, belt: Belt, job: Job) -> None:
    """The first job is gone: the next one comes to the end a pitch later, if it is not on its way there still."""
    drop(belt.jobs, job)
    belt.last_off_s = floor.now
    if len(belt.jobs) > 0 and belt.jobs[0].kind == QUEUE:
        _later(floor, belt, belt.jobs[0], belt.headway_s, line_of_closed_up)


@step
def ridden(floor: Floor, event: Event) -> None:
    """As much time is over as the ride takes: the job is at the end, or stands behind others."""
    belt: Belt = _as_belt(event.subject)
    job = event.job
    behind_s = belt.last_off_s + belt.headway_s - floor.now
    if belt.jobs[0] is not job:
        job_now(floor, job, QUEUE, 0)
    elif behind_s > 0:
        job_now(floor, job, QUEUE, 0)
        _later(floor, belt, job, behind_s, line_of_closed_up)
    else:
        operation_done(floor, job)


@step
def closed_up(floor: Floor, event: Event) -> None:
    """The job is at the end."""
    operation_done(floor, event.job)


@inlined
def _later(floor: Floor, belt: Belt, job: Job, delay_s: float, line: Call) -> None:
    event = alarm(floor, delay_s, COMPLETION, belt.rank, job.number, line, belt)
    event.job = job


line_of_ridden, line_of_closed_up = line_of(ridden), line_of(closed_up)


def install(build: Any) -> None:
    """Jobs that come to a conveyor get on, and who leaves it gets off."""
    rigid = []
    for plan in build.plan.conveyors:
        belt = _belt(build, plan)
        if plan.accumulating:
            hang(build, belt, get_on, get_off)
            build.line(ridden)
            build.line(closed_up)
        else:
            rigid.append(belt)
    rigid_conveyors.install(build, rigid)


def _belt(build: Any, plan: Any) -> Handle:
    made = build.arena.new("Belt")
    made.station, made.rank = build.stations[plan.station], len(build.plan.workers) + plan.station
    made.travel_s, made.headway_s, made.capacity = plan.travel_s, plan.headway_s, plan.capacity
    made.last_on_s = made.last_off_s = -inf
    return made
