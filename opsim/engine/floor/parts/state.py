"""What stands where on the floor right now: jobs, stations, workers. Structs of a run, changed only inside settle.

Truths are 0 or 1. What blocks hang in is a Hook: what is called, and its subject. Blocks have structs of their own
beside these.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from opsim.engine.floor.machine import Array, Call, List, struct
from opsim.engine.floor.parts.records import (
    Ahead,
    Claim,
    Columns,
    Event,
    Hook,
    Product,
    Seat,
    Source,
    Stream,
    Task,
)

if TYPE_CHECKING:
    from opsim.engine.floor.machine.memory import Memory
    from opsim.engine.floor.parts import structs_of_blocks as blocks

GOES_ON = -1
"""The ``stage`` of a job that lost its server in the middle of a task, and goes on there when it is seated again."""
DUTY, CREWS, LINES, FIRST_ROTATION = range(4)
"""Limits of who may be sent where, by their numbers; rotations follow."""


@struct
class Station:
    """tasks, automatic, repeats : of each task a job gets here: its rank, whether it needs no worker, how often

    calling : jobs on servers for which nobody was sent yet; wanted_by : gates of jobs that want in
    luck    : by task, durations of automatic runs to come; next_k : how many there were
    down    : for how many reasons it stands still; standing : jobs on servers that wait until it goes on
    stands_for : the cause that they wait for
    seated  : jobs on servers, where a block has to find them; else None
    per_lot : of each task, whether it is done once for a lot; else for each of its units

    What blocks hang in, each empty or nothing where none does:
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

    has_seated : whether seated jobs are known; luck, next_k : by task, of automatic runs
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
    on_floor        : 0 when it has left; before_on_floor, next_on_floor : as they came
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
    """walk_s : seconds by place, then station
    rating   : (S,) by station; skills : bit r set where he may be sent to station r now
    luck     : by task, durations to come at rating 1
    next_k   : by task, how often it was done
    round    : where the worker is on the round he patrols; served : whether he has worked at that stop
    walks_left : that he must still make, there and back, to bring all of the job he carries
    stint    : his part of a team's performance under way, which has a row of its own
    going    : whether he goes off shift as soon as he is done with what he is at
    staying  : the job whose tasks at its station he does to the end before he goes
    human    : the effects on him (``humans.Human``); pace_shift : by how much they shifted the log time he drew last

    version : of the stretch his process waits for; skills, own_skills : as bits
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
    n_down : reasons for which stations stand, all together
    alone : whether what happens now is the only thing in its instant; at_once : whether nothing follows of it but that
    the job which is done goes on, which may be let in then without a claim
    none_fits : whether it is known that nobody who is free can serve where somebody calls
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
    alone: int
    at_once: int
    done: Job
    active: Worker
    has_orders: int
    reports: List[Event]
    n_settled: int
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
    drawn_line: Call
    works_line: Call
    stops_line: Call
    errors_line: Call
    asked_task: int
    asked_k: int
    asked_s: float
    asked_until_s: float
    asked_done: float
    seen_to: int
    stretch_line: Call
    automatic_line: Call
    operation_line: Call
    report_line: Call
    tools_line: Call
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
