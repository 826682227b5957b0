"""What stands where on the floor right now: jobs, stations, workers. Data of a run, changed only inside settle."""

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

import simpy

from opsim.log import WAIT
from opsim.plan import Operation, ProductPlan, StationPlan, WorkerPlan


@dataclass(slots=True, eq=False)
class Job:
    """One unit of a product.

    kind, since_s   : the state it is in, and since when
    step, operation : where it is on its route, or wants to be next; ``operation_rank`` goes into its rows,
                      ``gate`` is in front of the operation
    task_position   : how many of the tasks at the station are done; ``repeats_done`` of the one under way
    worker .. duration_s : the performance under way, where ``kind`` is WORK; worker -1 where it is automatic
    visits          : how often each step was passed, where the way on is drawn
    """

    number: int
    product: int
    plan: ProductPlan
    step: int
    operation: Operation
    operation_rank: int
    gate: "Gate"
    kind: int
    cause: int
    since_s: float
    station: "Station | None" = None
    task_position: int = 0
    repeats_done: int = 0
    worker: int = -1
    task: int = -1
    performance_id: int = -1
    k: int = -1
    duration_s: float = 0.0
    held_by: "Worker | None" = None
    visits: dict[int, int] | None = None


Claim = tuple[float, int, Job]
"""(since_s, job number, job): claims are served in this order."""


@dataclass(slots=True, eq=False)
class Station:
    """tasks, automatic, repeats : of each task a job gets here: its rank, whether it needs no worker, how often

    calling : jobs on servers for which nobody was sent yet; wanted_by : gates of jobs that want in
    luck    : by task, durations of automatic runs to come; next_k : how many there were
    """

    plan: StationPlan
    rank: int
    place: int
    capacity: float
    tasks: tuple[int, ...]
    automatic: tuple[bool, ...]
    repeats: tuple[int, ...]
    free_servers: int
    queue: deque[Job] = field(default_factory=deque)
    calling: list[Claim] = field(default_factory=list)
    wanted_by: tuple["Gate", ...] = ()
    n_inside: int = 0
    luck: dict[int, Iterator[float]] = field(default_factory=dict)
    next_k: dict[int, int] = field(default_factory=dict)


@dataclass(slots=True, eq=False)
class Gate:
    """Jobs that want into a station, or into one of several: blocked on servers upstream, or just arrived."""

    stations: tuple[Station, ...]
    claims: list[Claim] = field(default_factory=list)

    @property
    def has_room(self) -> bool:
        """A place at one of the stations."""
        for station in self.stations:  # noqa: SIM110  NOTE: asked every settle step; any(...) takes four times as long
            if station.n_inside < station.capacity:
                return True
        return False

    def next_claim(self) -> Claim | None:
        """The oldest claim that can be met. A job that comes back to its own station needs no other place there."""
        claims = self.claims
        if not claims:
            return None
        for station in self.stations:
            if station.n_inside < station.capacity:
                return claims[0]
        return next((claim for claim in claims if claim[2].station in self.stations), None)


@dataclass(slots=True, eq=False)
class Worker:
    """``stretch_over``: the event its process waits for.

    walk_s   : (P, S) seconds from each place to each station
    rating   : (S,) by station; skills : bit r set where rating[r] > 0
    luck     : by task, durations to come at rating 1
    next_k   : by task, how often it was done
    round    : where the worker is on the round he patrols
    """

    plan: WorkerPlan
    rank: int
    place: int
    stretch_over: simpy.Event
    walk_s: tuple[tuple[float, ...], ...]
    rating: tuple[float, ...]
    skills: int
    luck: dict[int, Iterator[float]]
    next_k: list[int]
    kind: int = WAIT
    cause: int = 0
    since_s: float = 0.0
    station: Station | None = None
    job: Job | None = None
    walk_from: int = -1
    round: int = -1
