"""What stands where on the floor right now: jobs, stations, workers. Structs of a run, changed only inside settle.

The fields mean what those of ``simpy_engine.state`` and ``simpy_engine.floor`` mean. Truths are 0 or 1; a callable of
that engine is a Hook here: the line of a step, and its subject. Blocks have structs of their own beside these.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from opsim.engine.fast_engine.machine import Array, List, struct
from opsim.engine.fast_engine.machine.memory import Memory

if TYPE_CHECKING:
    from opsim.engine.fast_engine.parts import structs_of_blocks as blocks

GOES_ON = -1
"""The ``stage`` of a job that lost its server in the middle of a task, and goes on there when it is seated again."""
DUTY, CREWS, LINES, FIRST_ROTATION = range(4)
"""Limits of who may be sent where, by their numbers; rotations follow."""


@struct
class Hook:
    """line : of the step that is called; subject : what it is called with, after the floor; order : among others."""

    line: int
    subject: Any
    order: int


@struct
class Event:
    """What is to happen: a report of (kind, rank, number), applied by the step of a line. alive : 0 where cancelled

    version : of a worker's stretch, the one it belongs to; the rest is what the step needs to know.
    """

    line: int
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
    """A row of the event log, as wide as it is written; ``log`` of the engine makes columns of it."""

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
    """kind : its number in ``release.KINDS``; sequence : ranks of products in turn; ranks, mix : where they are drawn

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
class Station:
    """See ``simpy_engine.state.Station``. n_tasks, tasks, automatic, repeats, per_lot : of what a job gets here

    has_seated : whether seated jobs are known; luck, next_k : by task, of automatic runs
    receive, vacate, clear, serve, order, sent, before, act, acted : nothing where no block hangs in
    """

    rank: int
    place: int
    kind: int
    servers: int
    capacity: float
    buffer: float
    buffer_after: int
    priority: float
    n_tasks: int
    tasks: Array[int]
    automatic: Array[int]
    repeats: Array[int]
    per_lot: Array[int]
    free_servers: int
    queue: List[Job]
    calling: List[Claim]
    n_wanted_by: int
    wanted_by: Array[Gate]
    n_inside: int
    luck: Array[Stream]
    next_k: Array[int]
    down: int
    standing: List[Job]
    stands_for: int
    finishes_at_close: int
    has_hours: int
    switched: List[Hook]
    has_seated: int
    seated: List[Job]
    stages: List[Hook]
    readies: List[Hook]
    acts: List[Hook]
    acteds: List[Hook]
    afters: List[Hook]
    sent: Hook
    before: Hook
    order: Hook
    serve: Hook
    receive: Hook
    vacate: Hook
    clear: Hook
    meter: blocks.Wear
    setup_attended: int
    setups: blocks.Servers
    put_away: List[Job]
    subject: Any
    oven: blocks.Oven
    belt: blocks.Belt
    line: blocks.Line
    line_at: int


@struct
class Job:
    """See ``simpy_engine.state.Job``. on_floor : 0 when it has left; before_on_floor, next_on_floor : as they came

    asked_s, asked_done : what was drawn for the performance under way, before human effects, and how much of it was
    done then; asked : whether that is known. The rest, from ``visits`` on, belongs to blocks.
    """

    number: int
    n: int
    source: int
    product: int
    plan: Product
    step: int
    operation: int
    gate: Gate
    kind: int
    cause: int
    since_s: float
    station: Station
    task_position: int
    repeats_done: int
    worker: int
    task: int
    performance_id: int
    k: int
    duration_s: float
    pace_shift: float
    asked: int
    asked_s: float
    asked_done: float
    held_by: Worker
    progress_from: float
    rest_s: float
    over: Event
    stage: int
    setup_task: int
    with_tools: int
    has_team: int
    team: List[Worker]
    seat: Seat
    members: List[Job]
    ahead: Ahead
    cards: List[Any]
    priority: float
    due_s: float
    lot: int
    bad: int
    on_floor: int
    before_on_floor: Job
    next_on_floor: Job
    visits: Array[int]
    passes: List[int]
    reworks: List[int]
    block: blocks.JobBlocks


@struct
class Gate:
    """Jobs that want into a station, or into one of several. stirred : whether something may have changed for them

    mask : by station, whether it is one of these
    """

    rank: int
    n_stations: int
    stations: Array[Station]
    mask: Array[int]
    claims: List[Claim]
    comes_back: int
    stirred: int
    next: int
    choose: Hook
    allows: List[Hook]
    entered: List[Hook]
    given_up: Hook
    pick: Hook
    lets: Hook
    guard: Any


@struct
class Worker:
    """See ``simpy_engine.state.Worker``. version : of the stretch his process waits for; skills, own_skills : as bits

    limits : for each limit its bits; limited : whether it holds; in_free : whether he can be sent
    """

    rank: int
    home: int
    walk_m_per_s: float
    most_load_kg: float
    place: int
    version: int
    walk_s: Array[float]
    rating: Array[float]
    skills: Array[int]
    own_skills: Array[int]
    limits: Array[int]
    limited: Array[int]
    luck: Array[Stream]
    next_k: Array[int]
    kind: int
    cause: int
    since_s: float
    station: Station
    job: Job
    walk_from: int
    n_patrol: int
    patrol: Array[int]
    round: int
    walks_left: int
    served: int
    stint: blocks.Stint
    going: int
    staying: Job
    human: blocks.Human
    dose: blocks.Dose
    pace_shift: float
    in_free: int
    quality: Array[float]
    zone: Array[int]
    has_zone: int
    floater: int
    absence: float
    called_by: Any
    presence: blocks.Presence
    tied: Job


@struct
class Floor:
    """State and log of one replication; the first two fields are the machine's.

    now, env_now : the instant that is being settled, and that of the event; they differ only between events
    heap_* : events to come, by time, then by when they were set; n_events : set so far
    n_words : of a set of stations as bits; error : why the run has to end, 0 while all is well
    """

    table: int
    memory: Memory
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
    active: Worker
    has_orders: int
    reports: List[Event]
    n_settled: int
    row_first: int
    row_at: int
    row_end: int
    row_order: Array[int]
    flush_line: int
    more_rows: int
    columns: Columns
    room: int
    unordered: int
    last_end_s: float
    more_luck: int
    arena: int
    n_rows: int
    n_stations: int
    stations: Array[Station]
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
    saturated: List[Source]
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
    serves_one: int
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
    drawn_line: int
    works_line: int
    stops_line: int
    errors_line: int
    asked_task: int
    asked_k: int
    asked_s: float
    asked_until_s: float
    asked_done: float
    seen_to: int
    stretch_line: int
    automatic_line: int
    operation_line: int
    report_line: int
    tools_line: int
    found_worker: Worker
    found_station: Station
    has_legs: int
    legs: Array[Hook]
    stock: blocks.Stock
    kits: blocks.Kits
    crib: blocks.Crib
    teams: blocks.Teams
    holds: blocks.Holds
    helping: blocks.Helping
    people: blocks.People
    start_s: float
    subject: Any


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
