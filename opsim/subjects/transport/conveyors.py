"""Conveyors: jobs get on one after the other, as soon as there is room at the beginning, and ride to the end.

On an accumulating one each job rides on until it stands behind another one; on others all stand still while the job at
the end cannot get off. Positions are counted in seconds of travel.
"""

from __future__ import annotations

from math import inf
from typing import Any

from opsim.engine.floor.event_list import INF
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import operation_done
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import NOTHING, Call, Handle, List, cast, drop, index_of, inlined, line_of, step, struct
from opsim.engine.floor.state import Event, Job, Station
from opsim.engine.rules import COMPLETION
from opsim.log import QUEUE, TRANSPORT
from opsim.subjects.routes.routing import alarm, cancel, stir


@struct
class Belt:
    """rank : where its reports come among those of an instant, as a station's

    rigid : whether it stands still as a whole; on_at_s : of each of its ``jobs``, how long it had moved when it got on
    get_on_line, get_off_line : steps told of a job that gets on, or off
    """

    station: Station
    rank: int
    travel_s: float
    headway_s: float
    capacity: int
    jobs: List[Job]
    waiting: List[Job]
    last_on_s: float
    last_off_s: float
    opens: Event
    rigid: int
    moved_s: float
    since_s: float
    on_at_s: List[float]
    stands: int
    halted: int
    get_on_line: Call
    get_off_line: Call


@inlined
def moved_at_s(belt: Belt, now: float) -> float:
    """How long it has moved."""
    return belt.moved_s if belt.stands else belt.moved_s + (now - belt.since_s)


@inlined
def rest_s(belt: Belt, at: int, way_s: float, now: float) -> float:
    """For how long it has to move until the job number ``at`` on it is so far from the beginning."""
    return way_s - (moved_at_s(belt, now) - belt.on_at_s[at])


@inlined
def until_open_s(belt: Belt, now: float) -> float:
    """How long it has to move until the next job may get on; inf where it is full."""
    n = len(belt.jobs)
    if n >= belt.capacity:
        return INF
    if belt.rigid:
        return rest_s(belt, n - 1, belt.headway_s, now) if n else 0.0
    opens_s = max(belt.last_on_s + belt.headway_s, belt.last_off_s + (n + 1) * belt.headway_s - belt.travel_s)
    return opens_s - now


_as_belt = cast(Belt)


@step
def receive(floor: Floor, station: Station, job: Job) -> None:
    """A job has come to the belt, and gets on where there is room."""
    station.belt.waiting.append(job)
    let_on(floor, station.belt)


@step
def vacate(floor: Floor, station: Station, job: Job) -> None:
    """A job leaves the belt: it gets off, and makes room."""
    station.belt.get_off_line(floor, station.belt, job)
    let_on(floor, station.belt)


@step
def let_on(floor: Floor, belt: Belt) -> None:
    """Who waits gets on where there is room; the station says whether there is room for somebody else."""
    while len(belt.waiting) > 0 and until_open_s(belt, floor.now) <= 0:
        belt.get_on_line(floor, belt, belt.waiting.pop(0))
    wait_s = until_open_s(belt, floor.now)
    belt.station.capacity = float(belt.capacity) if wait_s <= 0 and len(belt.waiting) == 0 else 0.0
    floor.entries_full = 0
    forget_opening(floor, belt)
    if _moves(belt) and 0 < wait_s < INF:
        belt.opens = alarm(floor, wait_s, COMPLETION, belt.rank, -1, line_of_opens, belt)


@inlined
def _moves(belt: Belt) -> bool:
    """Whether its room for the next job comes with time."""
    return not belt.rigid or not belt.stands


@step
def forget_opening(floor: Floor, belt: Belt) -> None:
    """The report of room that is to come means nothing any more."""
    if belt.opens:
        cancel(belt.opens)
        belt.opens = NOTHING


@step
def opens(floor: Floor, event: Event) -> None:
    """There is room for one more."""
    belt: Belt = _as_belt(event.subject)
    belt.opens = NOTHING
    let_on(floor, belt)
    stir(floor, belt.station)


line_of_opens = line_of(opens)


def hang(build: Any, belt: Handle, get_on: Any, get_off: Any) -> None:
    """Jobs that come to the belt get on where there is room; who leaves it gets off, and makes room."""
    build.line(opens)
    belt.get_on_line, belt.get_off_line = build.line(get_on), build.line(get_off)
    station = belt.station
    station.belt = belt
    station.receive, station.vacate = build.hook(receive), build.hook(vacate)


@step
def get_on_rigid(floor: Floor, belt: Belt, job: Job) -> None:
    """A job gets on."""
    belt.on_at_s.append(moved_at_s(belt, floor.now))
    belt.jobs.append(job)
    job_now(floor, job, QUEUE if belt.halted else TRANSPORT, 0)
    if len(belt.jobs) == 1:
        _first_rides(floor, belt)


@step
def get_off_rigid(floor: Floor, belt: Belt, job: Job) -> None:
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


def install_rigid(build: Any, belts: list[Handle]) -> None:
    """Jobs that come to such a conveyor get on, and who leaves it gets off."""
    for belt in belts:
        belt.rigid = 1
        hang(build, belt, get_on_rigid, get_off_rigid)
        build.line(at_end)
        build.hang(build.floor.dispatchers, halt, belt)


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
    install_rigid(build, rigid)


def _belt(build: Any, plan: Any) -> Handle:
    made = build.arena.new("Belt")
    made.station, made.rank = build.stations[plan.station], len(build.plan.workers) + plan.station
    made.travel_s, made.headway_s, made.capacity = plan.travel_s, plan.headway_s, plan.capacity
    made.last_on_s = made.last_off_s = -inf
    return made
