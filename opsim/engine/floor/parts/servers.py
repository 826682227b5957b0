"""Servers with set-ups: what each did last, and what a job would need there."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, Call, List, inlined, struct
from opsim.engine.floor.parts.clock import INF
from opsim.engine.floor.parts.state import Job, Station

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
