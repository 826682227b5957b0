"""What the structs of ``state`` are made of: hooks, events, streams, rows, claims, ways of products, sources, tasks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from opsim.engine.floor.machine import Array, Call, List, struct

if TYPE_CHECKING:
    from opsim.engine.floor.parts.state import Gate, Job, Station, Worker


@struct
class Hook:
    """line : of the step that is called; subject : what it is called with, after the floor; order : among others."""

    line: Call
    subject: Any
    order: int


@struct
class Event:
    """What is to happen: a report of (kind, rank, number), applied by the step of a line. alive : 0 where cancelled

    version : of a worker's stretch, the one it belongs to; the rest is what the step needs to know.
    """

    line: Call
    alive: int
    kind: int
    rank: int
    number: int
    version: int
    worker: Worker
    job: Job
    station: Station
    subject: Any
    other: Any
    at_s: float


@struct
class Stream:
    """Numbers of a named stream. id : purpose and ranks, see ``luck``; data : those from number ``first`` up to ``end``

    next : number of the one that comes next; data_2, data_3 : of holds, the moments beside the durations
    """

    id: int
    data: Array[float]
    first: int
    end: int
    next: int
    data_2: Array[float]
    data_3: Array[float]


@struct
class Row:
    """A row of the event log, as wide as it is written; ``columns.put_rows`` makes columns of it."""

    kind: int
    start_s: float
    end_s: float
    worker: int
    station: int
    place_from: int
    place_to: int
    source: int
    job: int
    product: int
    operation: int
    task: int
    performance_id: int
    k: int
    progress_from: float
    progress_to: float
    pace_shift: float
    cause: int


@struct
class Columns:
    """Where the columns of the event log are, in the order of ``opsim.log.COLUMNS``: addresses of their first items."""

    kind: int
    start_s: Array[float]
    end_s: Array[float]
    worker: int
    station: int
    place_from: int
    place_to: int
    source: int
    job: Array[int]
    product: int
    operation: int
    task: int
    performance_id: Array[int]
    k: Array[int]
    progress_from: Array[float]
    progress_to: Array[float]
    pace_shift: Array[float]
    cause: int


@struct
class Claim:
    """What a job puts down where it waits for something: served by (before, since_s, number); before : -priority

    seen : whether the guard of a gate with cards has looked at it
    """

    before: float
    since_s: float
    number: int
    job: Job
    seen: int


@struct
class Way:
    """Where jobs go on: n ways, by cumulative probability, each to a step of the route; -1: out."""

    n: int
    cumulative: Array[float]
    to: Array[int]


@struct
class RouteStep:
    """An operation of a product, its rank, and the gate in front of it. position : by station, where it is in the list

    chances : streams that decide where jobs go on, by visit x sources + source
    """

    operation: int
    gate: Gate
    position: Array[int]
    way: Way
    chances: List[Stream]


@struct
class Product:
    """mass_kg : of one unit, NaN where nobody asks; at_s, work_s, left_s, left_steps : see ``plan.WorkAhead``."""

    rank: int
    n_steps: int
    steps: Array[RouteStep]
    start: Way
    start_chances: List[Stream]
    carried: int
    priority: float
    due_s: float
    lot: int
    mass_kg: float
    at_s: Array[float]
    work_s: Array[float]
    left_s: Array[float]
    left_steps: Array[float]


@struct
class Source:
    """kind : ``release.BY_TIME`` or another there; sequence : ranks of products in turn; ranks, mix : those drawn

    orders : of a schedule; next_order : the one that comes next; to_s, hours : where gaps count open time alone
    """

    rank: int
    kind: int
    loses: int
    at_once: int
    n_released: int
    next_gate: Gate
    next_product: int
    next_step: int
    closed: int
    n_sequence: int
    sequence: Array[int]
    n_mix: int
    ranks: Array[int]
    mix: Stream
    gaps: Stream
    n_arrived: int
    n_orders: int
    orders: Array[Order]
    next_order: int
    n_hours: int
    hours: Array[float]
    next_hour: int
    at_s: float
    until_s: float
    store: int
    level: int


@struct
class Order:
    """Of a schedule. priority : NaN where the product's own stands; product : -1 where it is drawn from the mix."""

    time_s: float
    first: int
    quantity: int
    product: int
    due_s: float
    priority: float


@struct
class Seat:
    """A server that several jobs share; n_jobs : that are on it still."""

    n_jobs: int
    setup: int


@struct
class Ahead:
    """A place that a job wants, or has, at a step to come. station : where it is kept, or nothing; own : its own place

    cards : that were taken for it
    """

    step: int
    gate: Gate
    station: Station
    own: int
    cards: List[Any]


@struct
class Task:
    """Of a Plan, by rank. rule : of interruption, -1 where the shift's holds; hold_tool : -1 where none is held."""

    rank: int
    repeat: int
    automatic: int
    attended: int
    team: int
    per_lot: int
    rule: int
    mean_s: float
    n_needs: int
    needs: Array[int]
    hold_tool: int
    subject: Any
