"""What stands where on the floor right now: jobs, stations, workers. Data of a run, changed only inside settle."""

from collections import deque
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import simpy

from opsim.log import WAIT
from opsim.plan import Operation, StationPlan, WorkerPlan


class Performance(NamedTuple):
    """One execution of a task under way; ``worker`` is -1 where the task is automatic."""

    worker: int
    task: int
    number: int
    k: int
    start_s: float
    duration_s: float


@dataclass(slots=True, eq=False)
class Job:
    """One unit of a product; ``kind`` and ``since_s``: the state it is in, ``task_position``: where in the tasks."""

    number: int
    product: int
    operation: Operation
    operation_rank: int
    kind: int
    cause: int
    since_s: float
    step: int = 0
    station: "Station | None" = None
    task_position: int = 0
    repeats_done: int = 0
    performance: Performance | None = None
    held_by: "Worker | None" = None


Claim = tuple[float, int, Job]
"""(since_s, job number, job): claims are served in this order."""


@dataclass(slots=True, eq=False)
class Station:
    """``calling``: jobs on servers for which nobody was sent yet; ``wanted_by``: gates of jobs that want in."""

    plan: StationPlan
    rank: int
    free_servers: int
    queue: deque[Job] = field(default_factory=deque)
    calling: list[Claim] = field(default_factory=list)
    wanted_by: list["Gate"] = field(default_factory=list)
    n_inside: int = 0

    @property
    def has_room(self) -> bool:
        return self.n_inside < self.plan.capacity


@dataclass(slots=True, eq=False)
class Gate:
    """Jobs that want into a station, or into one of several: blocked on servers upstream, or just arrived."""

    stations: tuple[Station, ...]
    claims: list[Claim] = field(default_factory=list)


@dataclass(slots=True, eq=False)
class Worker:
    """``stretch_over``: the event its process waits for; ``next_k``: how often it has done each task."""

    plan: WorkerPlan
    rank: int
    place: int
    next_k: list[int]
    stretch_over: simpy.Event
    kind: int = WAIT
    cause: int = 0
    since_s: float = 0.0
    station: Station | None = None
    job: Job | None = None
    walk_from: int = -1
    effects: dict[int, Any] = field(default_factory=dict)
