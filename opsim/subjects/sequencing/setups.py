"""Servers with set-ups: what each did last, and what a job would need there.

Set-ups: each server remembers what it did last, and is set up for a job of another class.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.event_list import INF
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import log_job
from opsim.engine.floor.machine import NOTHING, Array, Call, List, drop, fresh, give_back, inlined, step, struct
from opsim.engine.floor.state import Job, Station
from opsim.subjects.stations.station import begin_setup

KNOWN = 2
"""Is added to a class, or to ANYTHING, where 0 says that a job or a seat has no server of those."""


@struct
class Servers:
    """takes_line, leaves_line : steps told of a job that takes a server, and of one that leaves it

    class_of : (P,); task, mean_s : (C, C), see ``plan.SetupPlan``; free : what each server without a job did last
    """

    takes_line: Call
    leaves_line: Call
    n_classes: int
    class_of: Array[int]
    task: Array[int]
    mean_s: Array[float]
    free: List[int]


@struct
class Stopped:
    """The work a job was in: whose and which, and what is left of it, as the job says it."""

    worker: int
    k: int
    performance_id: int
    pace_shift: float
    asked: int
    asked_s: float
    asked_done: float
    rest_s: float
    progress_from: float


@inlined
def _change(servers: Servers, last: int, product: int) -> int:
    """Where the set-up from a class to that of a product stands; class -1 means the last, as in ``SetupPlan``."""
    here = servers.class_of[product]
    return last * servers.n_classes + (here if here >= 0 else here + servers.n_classes)


@inlined
def needed_task(servers: Servers, last: int, product: int) -> int:
    """The task of the set-up for a product on a server that last did a class; -1: none."""
    return -1 if last < 0 else servers.task[_change(servers, last, product)]


@inlined
def needed_s(servers: Servers, last: int, product: int) -> float:
    """Its mean time."""
    return 0.0 if last < 0 else servers.mean_s[_change(servers, last, product)]


@inlined
def last_on(job: Job) -> int:
    """KNOWN + what the server of a job, or of all that share it, did last; 0: it has none of those."""
    return job.seat.setup if job.seat else job.block.server


@inlined
def set_last_on(job: Job, known: int) -> None:
    if job.seat:
        job.seat.setup = known
    else:
        job.block.server = known


@inlined
def setup_s(station: Station, job: Job) -> float:
    """Mean time of the shortest set-up for a job now: of the free servers, or of all where none is free."""
    servers = station.setups
    if not servers:
        return 0.0
    shortest_s = INF
    for worker in servers.free:
        shortest_s = min(shortest_s, needed_s(servers, worker, job.product))
    if not servers.free:
        for other in station.seated:
            known = last_on(other)
            if known:
                shortest_s = min(shortest_s, needed_s(servers, known - KNOWN, job.product))
    return shortest_s


SETTING_UP_COMES = 40
"""The place of set-ups among the preparations of a job."""
_new_stopped, _forget_stopped = fresh(Stopped), give_back(Stopped)


@step
def take_server(floor: Floor, station: Station, job: Job) -> None:
    """The job takes the free server with the shortest set-up, unless it shares one that was taken."""
    if last_on(job):
        return
    servers = station.setups
    free = servers.free
    last = free[0]
    for i in range(1, len(free)):
        own_s, other_s = needed_s(servers, last, job.product), needed_s(servers, free[i], job.product)
        if other_s < own_s or (other_s == own_s and free[i] < last):
            last = free[i]
    drop(free, last)
    set_last_on(job, last + KNOWN)


@step
def give_server(floor: Floor, station: Station, job: Job) -> None:
    """The job leaves its server, which others may share."""
    job.block.setups_left = 0
    if job.seat and job.seat.n_jobs != 1:
        return
    station.setups.free.append(last_on(job) - KNOWN)
    set_last_on(job, 0)


@step
def set_up(floor: Floor, subject: Any, job: Job) -> bool:
    """Set the job's server up, as often as the task is repeated; True where the server is as the job needs it."""
    servers, block = job.station.setups, job.block
    task = needed_task(servers, last_on(job) - KNOWN, job.product)
    left = block.setups_left - 1
    if left < 0:
        left = 0 if task < 0 else floor.tasks[task].repeat
        if left and job.rest_s:
            _put_by(floor, job)
    if left:
        block.setups_left = left
        begin_setup(floor, job, task)
        return False
    set_last_on(job, servers.class_of[job.product] + KNOWN)
    take_up(floor, job)
    return True


@step
def _put_by(floor: Floor, job: Job) -> None:
    """Keep what was left of the job's work until its server is set up for it."""
    if not job.block.stopped:
        job.block.stopped = _new_stopped(floor)
    stopped = job.block.stopped
    stopped.worker, stopped.k, stopped.performance_id = job.worker, job.k, job.performance_id
    stopped.pace_shift, stopped.rest_s, stopped.progress_from = job.pace_shift, job.rest_s, job.progress_from
    stopped.asked, stopped.asked_s, stopped.asked_done = job.asked, job.asked_s, job.asked_done
    job.rest_s = job.progress_from = 0.0


@step
def take_up(floor: Floor, job: Job) -> None:
    """The job has before it what was left of its work when it lost its server."""
    stopped = job.block.stopped
    if not stopped:
        return
    job.block.stopped = NOTHING
    log_job(floor, job)  # the set-up, while it is known who did it
    job.since_s = floor.now
    job.worker, job.k, job.performance_id = stopped.worker, stopped.k, stopped.performance_id
    job.pace_shift, job.rest_s, job.progress_from = stopped.pace_shift, stopped.rest_s, stopped.progress_from
    job.asked, job.asked_s, job.asked_done = stopped.asked, stopped.asked_s, stopped.asked_done
    _forget_stopped(floor, stopped)


def install(build: Any) -> None:
    """Stations with set-ups."""
    for plan in build.plan.setups:
        build.keep_jobs()
        station = build.stations[plan.station]
        servers = station.setups = build.arena.new("Servers")
        station.has_seated, station.setup_attended = 1, plan.attended
        servers.takes_line, servers.leaves_line = build.line(take_server), build.line(give_server)
        servers.n_classes, servers.class_of = len(plan.task), build.ints(plan.class_of)
        servers.task = build.ints(task for row in plan.task for task in row)
        servers.mean_s = build.floats(mean_s for row in plan.mean_s for mean_s in row)
        servers.free.extend([plan.first] * station.servers)
        build.hang(station.stages, set_up, None, SETTING_UP_COMES)
