"""Pre-emption: a job of higher priority takes the server of a lower one."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.interruption import forget_progress, interrupt
from opsim.engine.floor.machine import NOTHING, cast, inlined, step
from opsim.engine.floor.material import be_unseated, give_up_place
from opsim.engine.floor.parts.preempting import Preempting
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import GOES_ON, Floor, Job, Station
from opsim.engine.floor.setup import take_up
from opsim.engine.floor.station import call_off, next_in_line, seat
from opsim.engine.rules import sequencing
from opsim.log import AWAY, HELD, NO_WORKER, PREEMPTED, QUEUE, WALK, WORK

RESTART = "restart"
_may_preempt, _victim_key = inlined(sequencing.may_preempt), inlined(sequencing.victim_key)
_as_job = cast(Job)


@step
def preempt(floor: Floor, what: Preempting) -> bool:
    """True where servers changed hands."""
    changed, station = False, what.station
    while len(station.queue) > 0 and not station.down:
        job = _victim(floor, station)
        if not job:
            break
        _give_up_server(floor, station, job, what.restart)
        changed = True
    return changed


@step
def _victim(floor: Floor, station: Station) -> Job:
    """Who loses the server to the first of the queue; nothing: nobody is of lower priority and can be broken off."""
    highest = station.queue[0].priority
    for i in range(1, len(station.queue)):
        highest = max(highest, station.queue[i].priority)
    found: Job = _as_job(0)
    for job in station.seated:
        if _may_preempt(highest, job.priority) and _can_stop(job) and (not found or _gives_way_before(job, found)):
            found = job
    return found


@inlined
def _gives_way_before(one: Job, other: Job) -> bool:
    key = _victim_key(one.priority, one.since_s, one.number)
    return key < _victim_key(other.priority, other.since_s, other.number)


@inlined
def _can_stop(job: Job) -> bool:
    """In work, or waiting for a worker: who waits for a place, parts or a tool, or is set up for, keeps the server."""
    return job.kind == WORK or (job.kind == HELD and (job.cause == NO_WORKER or job.cause == AWAY))


@step
def _give_up_server(floor: Floor, station: Station, job: Job, restart: int) -> None:
    if job.kind == WORK:
        interrupt(floor, job, PREEMPTED)
    else:
        _call_off(floor, station, job)
    if station.setups:
        take_up(floor, job)
    if restart:
        forget_progress(floor, job)
    if job.ahead and not job.ahead.own:  # else who took the server might wait for it
        give_up_place(floor, job, job.ahead)
    for told in floor.lost_server:
        told.line(floor, told.subject, job, station)
    job_now(floor, job, QUEUE, PREEMPTED)
    job.stage = GOES_ON
    be_unseated(floor, station, job)
    station.free_servers += 1
    station.queue.append(job)
    seat(floor, station, next_in_line(floor, station))


@step
def _call_off(floor: Floor, station: Station, job: Job) -> None:
    """The job calls for nobody any more; who is on his way to it comes all the same, and is free there."""
    call_off(floor, station, job)
    if job.setup_task >= 0:
        forget_progress(floor, job)  # of the set-up: its server is another's now
        job.setup_task = -1
    for rank in range(floor.n_workers):
        worker = floor.workers[rank]
        if worker.kind == WALK and worker.job is job:
            worker.job = NOTHING


def install(build: Any) -> None:
    """Stations where what was begun may be broken off for something more important."""
    for queue in build.plan.queues:
        if queue.preempt:
            what = build.arena.new("Preempting")
            what.station, what.restart = build.stations[queue.station], queue.preempt == RESTART
            build.seat(what.station)
            build.hang(build.floor.dispatchers, preempt, what)
