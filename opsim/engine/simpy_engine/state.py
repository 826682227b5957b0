"""What stands where on the floor right now: jobs, stations, workers. Data of a run, changed only inside settle."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING, Any, Protocol

import simpy

from opsim.log import AFTER, CLOSED, IS_DOWN, WAIT
from opsim.plan import Operation, ProductPlan, SourcePlan, StationPlan, WorkerPlan

if TYPE_CHECKING:
    from opsim.engine.simpy_engine.floor import Floor
    from opsim.engine.simpy_engine.setup import Servers

CREWS = "crews"
"""The limit of who is in a crew: his crew alone sends him."""
GOES_ON = -1
"""The ``stage`` of a job that lost its server in the middle of a task, and goes on there when it is seated again."""


@dataclass(slots=True, eq=False)
class Source:
    """Where jobs come from. n_released : jobs so far; product : the rank of the product that the n-th job is

    next_gate, next_want : of a saturated source, the gate that its next job wants in by, its product and step
    closed : whether it asks for nothing now, being out of its hours
    """

    plan: SourcePlan
    rank: int
    product: Callable[[int], int]
    n_released: int = 0
    next_gate: Gate | None = None
    next_want: tuple[int, int] = (-1, -1)
    closed: bool = False


@dataclass(slots=True, eq=False)
class Seat:
    """A server that several jobs share, those of a batch or the pieces of a split: free when the last has left it.

    A station makes room for them (``capacity``), which goes with them.
    """

    n_jobs: int


@dataclass(slots=True, eq=False)
class Ahead:
    """A place that a job wants, or has, at its next operation before it is done with this one.

    station : where the place is kept; None while the job waits for it
    own     : whether it is the place where the job is, which counts once
    cards   : that were taken for it
    """

    step: int
    gate: Gate
    station: Station | None = None
    own: bool = False
    cards: list[Any] = field(default_factory=list)


Claim = tuple[float, float, int, "Job"]
"""(-priority, since_s, job number, job): claims are served in this order."""


def claim_of(job: Job, since_s: float) -> Claim:
    """What a job puts down where it waits for something since some time."""
    return -job.priority, since_s, job.number, job


Stage = Callable[["Floor", "Job"], bool]
"""A preparation of a job that has its server: True where it is done; False where the job waits for something. Who ends
the wait calls ``proceed``, which asks again."""
Hook = Callable[["Floor", "Job"], bool]
"""Asked when a job's operation is done; False where the job is gone, or sent elsewhere."""


Ready = Callable[["Floor", "Job"], bool]
"""Asked before each task; False where the job waits for something, or its operation is over."""
Act = Callable[["Floor", "Job", "Worker"], bool]
"""Another way to begin a task than to perform it alone; True where it was seen to."""


class Meter(Protocol):
    """Counts what a station does: the begin and the end of each performance, and each operation done."""

    def begin(self, floor: Floor) -> None: ...
    def end(self, floor: Floor) -> None: ...
    def cycle(self, floor: Floor) -> None: ...


@dataclass(slots=True, eq=False)
class Station:
    """tasks, automatic, repeats : of each task a job gets here: its rank, whether it needs no worker, how often

    calling : jobs on servers for which nobody was sent yet; wanted_by : gates of jobs that want in
    luck    : by task, durations of automatic runs to come; next_k : how many there were
    down    : for how many reasons it stands still; standing : jobs on servers that wait until it goes on
    stands_for : the cause that they wait for
    seated  : jobs on servers, where a block has to find them; else None
    per_lot : of each task, whether it is done once for a lot; else for each of its units

    What blocks hang in, each empty or None where none does:
    stages  : preparations of a seated job, in their order
    ready   : asked before each task; False where it waits, and who ends the wait calls ``next_task``, or is left
    sent    : told of a job with ``with_tools`` that a worker is sent to
    before  : of such a job, the stations whose first call has waited longer for the same tools
    act, acted : other ways to perform a task: asked when a worker begins, and when his stretch is over; True: seen to
    after   : asked when an operation is done, in their order
    order   : key by which the next job of the queue is chosen; None: first come, first served
    serve   : fills free servers from the queue, in place of one job at a time; asked after each arrival too
    receive, vacate : in place of arriving at a server or the queue, and of giving the server back
    meter   : counts performances and operations
    setup_attended : whether a worker sets it up; setups : what its servers are set up for
    switched : told when the station closes (True) or opens
    clear   : told of each finished job that has to go on, which may leave its server; put_away : those that have
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
    wanted_by: tuple[Gate, ...] = ()
    n_inside: int = 0
    luck: dict[int, Iterator[float]] = field(default_factory=dict)
    next_k: dict[int, int] = field(default_factory=dict)
    down: int = 0
    standing: list[Job] = field(default_factory=list)
    stands_for: int = IS_DOWN
    switched: list[Callable[[Floor, bool], None]] = field(default_factory=list)
    seated: list[Job] | None = None
    stages: tuple[Stage, ...] = ()
    ready: Ready | None = None
    sent: Callable[[Floor, Job], None] | None = None
    before: Callable[[Floor, Job], list[Station]] | None = None
    act: Act | None = None
    acted: Act | None = None
    after: tuple[Hook, ...] = ()
    order: Callable[[Job], Any] | None = None
    serve: Callable[[Floor, Station], None] | None = None
    receive: Callable[[Floor, Station, Job], None] | None = None
    vacate: Callable[[Floor, Station, Job], None] | None = None
    meter: Meter | None = None
    per_lot: tuple[bool, ...] = ()
    setup_attended: bool = True
    setups: Servers | None = None
    clear: Callable[[Floor, Station, Job], None] | None = None
    put_away: list[Job] = field(default_factory=list)
    ordered_stages: list[tuple[int, Stage]] = field(default_factory=list)
    ordered_hooks: list[tuple[int, Hook]] = field(default_factory=list)
    ordered_acts: list[tuple[int, Act]] = field(default_factory=list)
    ordered_readies: list[tuple[int, Ready]] = field(default_factory=list)

    @property
    def finishes(self) -> bool:
        """Whether it is closed, and nothing else keeps it from finishing what was begun before."""
        return self.down == 1 and self.stands_for == CLOSED and self.plan.at_close == "finish"

    def add_stage(self, order: int, stage: Stage) -> None:
        """One more preparation; they come in the order of their numbers."""
        self.ordered_stages.append((order, stage))
        self.stages = tuple(found for _, found in sorted(self.ordered_stages, key=lambda pair: pair[0]))

    def add_after(self, order: int, hook: Hook) -> None:
        """One more question when an operation is done; they come in the order of their numbers."""
        self.ordered_hooks.append((order, hook))
        self.after = tuple(found for _, found in sorted(self.ordered_hooks, key=lambda pair: pair[0]))

    def add_ready(self, order: int, ready: Ready) -> None:
        """One more question before each task; they are asked in the order of their numbers, until one says no."""
        self.ordered_readies.append((order, ready))
        asked = [found for _, found in sorted(self.ordered_readies, key=lambda pair: pair[0])]
        self.ready = asked[0] if len(asked) == 1 else lambda floor, job: all(one(floor, job) for one in asked)

    def add_act(self, order: int, act: Act) -> None:
        """One more way to begin a task; they are asked in the order of their numbers, until one has seen to it."""
        self.ordered_acts.append((order, act))
        acts = [found for _, found in sorted(self.ordered_acts, key=lambda pair: pair[0])]
        self.act = acts[0] if len(acts) == 1 else lambda *asked: any(one(*asked) for one in acts)


OUTSIDE = Station(StationPlan("", -1, 0, 0, ()), -1, -1, 0, (), (), (), 0)
"""Where a job is that has come in and has no place yet: at no station, of rank -1. Nothing about it ever changes."""


@dataclass(slots=True, eq=False)
class Job:
    """One unit of a product, or a lot.

    number          : n * sources + source, so that no two jobs have the same; n : its number in its source
    kind, since_s   : the state it is in, and since when
    step, operation : where it is on its route, or wants to be next; ``operation_rank`` goes into its rows,
                      ``gate`` is in front of the operation
    task_position   : how many of the tasks at the station are done; ``repeats_done`` of the one under way
    worker .. pace_shift : the performance under way, where ``kind`` is WORK or SETUP; worker -1 where it is automatic
    asked           : what was drawn for it, before human effects, and how much of it was done then; None: nobody was
    progress_from, rest_s : where it goes on, and how many seconds are left, of a performance that was interrupted
    over            : the end of an automatic run under way
    stage           : how many of the station's preparations are done
    setup_task      : the set-up under way or called for; -1: none
    with_tools      : whether it calls for a worker who takes tools with him; team : who has come, or is on his way
    visits          : how often each step was passed, where the way on is drawn
    due_s           : when it should be done; bad : whether a defect is in it
    """

    number: int
    product: int
    plan: ProductPlan
    step: int
    operation: Operation
    operation_rank: int
    gate: Gate
    kind: int
    cause: int
    since_s: float
    source: int = 0
    n: int = 0
    station: Station = OUTSIDE
    task_position: int = 0
    repeats_done: int = 0
    worker: int = -1
    task: int = -1
    performance_id: int = -1
    k: int = -1
    duration_s: float = 0.0
    pace_shift: float = 0.0
    asked: tuple[float, float] | None = None
    held_by: Worker | None = None
    visits: dict[int, int] | None = None
    progress_from: float = 0.0
    rest_s: float = 0.0
    over: simpy.Event | None = None
    stage: int = 0
    setup_task: int = -1
    with_tools: bool = False
    team: list[Worker] | None = None
    seat: Seat | None = None
    members: tuple[Job, ...] = ()
    ahead: Ahead | None = None
    cards: list[Any] | None = None
    priority: float = 0.0
    due_s: float = inf
    lot: int = 1
    bad: bool = False

    @property
    def keeps_place(self) -> bool:
        """Whether it needs no other place where it is: who is behind the servers, or shares one, would need one."""
        return (self.ahead is None or self.ahead.station is None) and self.seat is None and self.cause != AFTER


@dataclass(slots=True, eq=False)
class Gate:
    """Jobs that want into a station, or into one of several: blocked on servers upstream, or just arrived.

    choose  : which of several stations a job takes; None: the fewest jobs a server
    allows  : whether a job may come in where there is room; entered : told of each that does; None: all may
    given_up : told of each job that gives the place up that was kept for it
    pick    : in place of ``next_claim``; lets : whether a new job of a product, at a step, may come in
    comes_back : whether a job at one of the stations may want in again, or have a place there before it leaves another
    """

    stations: tuple[Station, ...]
    claims: list[Claim] = field(default_factory=list)
    choose: Callable[[list[Station], Job], Station] | None = None
    allows: Callable[[Job], bool] | None = None
    entered: Callable[[Floor, Job], None] | None = None
    given_up: Callable[[Floor, Job], None] | None = None
    pick: Callable[[], Claim | None] | None = None
    lets: Callable[[int, int], bool] | None = None
    comes_back: bool = True

    @property
    def has_room(self) -> bool:
        """A place at one of the stations."""
        for station in self.stations:  # noqa: SIM110  NOTE: asked every settle step; any(...) takes four times as long
            if station.n_inside < station.capacity:
                return True
        return False

    def next_claim(self) -> Claim | None:
        """The first claim that can be met. A job that comes back to its own station needs no other place there."""
        claims = self.claims
        if not claims:
            return None
        if self.pick is not None:
            return self.pick()
        if self.allows is not None:
            return next((claim for claim in claims if self.may_enter(claim[3])), None)
        for station in self.stations:
            if station.n_inside < station.capacity:
                return claims[0]
        if not self.comes_back:  # NOTE: a long queue outside is not gone through again and again
            return None
        return next((claim for claim in claims if self.may_enter(claim[3])), None)

    def may_enter(self, job: Job) -> bool:
        """Whether there is room for a job, and nothing else keeps it out."""
        if job.ahead is not None and job.ahead.station is not None:
            return True
        room = self.has_room or (job.station in self.stations and job.keeps_place)
        return room and (self.allows is None or self.allows(job))


@dataclass(slots=True, eq=False)
class Worker:
    """``stretch_over``: the event its process waits for.

    walk_s   : (P, S) seconds from each place to each station
    rating   : (S,) by station; skills : bit r set where he may be sent to station r now
    limits   : by block, the stations that it leaves him, as bits: ``skills`` are those with a rating that all leave
    luck     : by task, durations to come at rating 1
    next_k   : by task, how often it was done
    round    : where the worker is on the round he patrols; served : whether he has worked at that stop
    walks_left : that he must still make, there and back, to bring all of the job he carries
    stint    : his part of a team's performance under way, which has a row of its own
    going    : whether he goes off shift as soon as he is done with what he is at
    staying  : the job whose tasks at its station he does to the end before he goes
    human    : the effects on him (``humans.Human``); pace_shift : by how much they shifted the log time he drew last
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
    walks_left: int = 0
    served: bool = False
    process: simpy.Process | None = None
    stint: Any = None
    going: bool = False
    staying: Job | None = None
    human: Any = None
    pace_shift: float = 0.0
    limits: dict[str, int] = field(default_factory=dict)

    def restrict(self, block: str, stations: int | None) -> None:
        """A block leaves him the stations whose bits are set; None: all of them."""
        if stations is None:
            self.limits.pop(block, None)
        else:
            self.limits[block] = stations
        self.skills = self.skills_but_for()

    def skills_but_for(self, *blocks: str) -> int:
        """The stations, as bits, that his ratings leave him and all blocks but some."""
        skills = sum(1 << rank for rank, rating in enumerate(self.rating) if rating > 0)
        for block, left in self.limits.items():
            if block not in blocks:
                skills &= left
        return skills

    def may_serve(self, station: Station) -> bool:
        """Whether he may be sent to a station now."""
        return self.skills >> station.rank & 1 == 1
