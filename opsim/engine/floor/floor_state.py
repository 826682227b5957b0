"""The floor of one replication as a whole: its clock and events to come, its log, and all that stands on it."""

from __future__ import annotations

from typing import Annotated, Any

from opsim.engine.floor.machine import Array, Call, List, struct
from opsim.engine.floor.records import Hook, Stream, Task
from opsim.engine.floor.state import Event, Gate, Job, Product, Station, Worker

ENDLESS, NO_LUCK = 1, 2
"""Why a run has to end: a loop of zero delays; numbers that could not be drawn."""
DUTY, CREWS, LINES, FIRST_ROTATION = range(4)
"""Limits of who may be sent where, by their numbers; rotations follow."""


@struct
class Floor:
    """State and log of one replication; the first two fields are the machine's.

    now, env_now : the instant that is being settled, and that of the event; they differ only between events
    heap_* : events to come, by time, then by when they were set; n_events : set so far
    n_words : of a set of stations as bits; error : why the run has to end, 0 while all is well
    n_down : reasons for which stations stand, all together
    alone : whether what happens now is the only thing in its instant; at_once : whether nothing follows of it but that
    the job which is done goes on, which may be let in then without a claim
    done : the job whose operation a worker has ended just now, unless it has left the floor
    none_fits : whether it is known that nobody who is free can serve where somebody calls
    entries_full : whether it is known that no saturated source has room for its next job
    """

    table: int
    memory: Annotated[Any, "Memory"]
    now: float
    env_now: float
    horizon_s: float
    error: int
    heap_n: int
    heap_room: int
    heap_time: Array[float]
    heap_order: Array[int]
    heap_event: Array[Event]
    n_events: int
    settle_pending: int
    alone: int
    at_once: int
    done: Job
    active: Worker
    has_orders: int
    reports: List[Event]
    row_first: int
    row_at: int
    row_end: int
    row_order: Array[int]
    flush_line: Call
    more_rows: int
    columns: Columns
    room: int
    unordered: int
    last_end_s: float
    more_luck: int
    drawn: Array[int]
    n_rows: int
    n_stations: int
    stations: Array[Station]
    n_down: int
    n_workers: int
    workers: Array[Worker]
    n_products: int
    products: Array[Product]
    n_sources: int
    sources: Array[Source]
    n_tasks: int
    tasks: Array[Task]
    n_places: int
    distance_m: Array[float]
    n_gates: int
    gates: Array[Gate]
    stirred: List[Gate]
    n_words: int
    calls: Array[int]
    free: List[Worker]
    n_calling: int
    none_fits: int
    saturated: List[Source]
    entries_full: int
    losing: int
    n_open: int
    first_job: Job
    last_job: Job
    n_jobs: int
    keeps_jobs: int
    has_job_blocks: int
    n_performances: int
    rule: int
    idle: int
    held_when_blocked: int
    routing: int
    n_limits: int
    starts: List[Hook]
    dispatchers: List[Hook]
    created: List[Hook]
    left_station: List[Hook]
    left_floor: List[Hook]
    broken_off: List[Hook]
    call_off: List[Hook]
    lost_server: List[Hook]
    closing: List[Hook]
    handed_over: Job
    outside: Station
    no_gate: Gate
    no_source: Source
    no_worker: Worker
    prefixes: List[Hook]
    key_n: int
    key: Array[float]
    best_key: Array[float]
    has_humans: int
    drawn_line: Call
    works_line: Call
    stops_line: Call
    errors_line: Call
    has_levels: int
    level_line: Call
    asked_task: int
    asked_k: int
    asked_s: float
    asked_until_s: float
    asked_done: float
    stretch_line: Call
    automatic_line: Call
    operation_line: Call
    report_line: Call
    tools_line: Call
    found_worker: Worker
    found_station: Station
    has_legs: int
    legs: Array[Hook]
    stock: Annotated[Any, "Stock"]
    kits: Annotated[Any, "Kits"]
    crib: Annotated[Any, "Crib"]
    teams: Annotated[Any, "Teams"]
    holds: Annotated[Any, "Holds"]
    helping: Annotated[Any, "Helping"]
    people: Annotated[Any, "People"]
    start_s: float
    subject: Any


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
