"""What stands where on the floor right now: jobs, stations, workers. Structs of a run, changed only inside settle.

Truths are 0 or 1. What blocks hang in is a Hook: what is called, and its subject. Blocks have structs of their own
beside these, which are known by their names here: the core imports no block.
"""

from __future__ import annotations

from typing import Annotated, Any

from opsim.engine.floor.machine import Array, Call, List, struct
from opsim.engine.floor.records import Hook, Seat, Stream, Way

GOES_ON = -1
"""The ``stage`` of a job that lost its server in the middle of a task, and goes on there when it is seated again."""


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
    readies : asked before each task; False where it waits, and who ends the wait calls ``next_task``, or is left
    sent    : told of a job with ``with_tools`` that a worker is sent to
    before  : of such a job, the stations whose first call has waited longer for the same tools
    acts, acteds : other ways to perform a task: asked when a worker begins, and when his stretch is over; True: seen to
    afters  : asked when an operation is done, in their order
    order   : key by which the next job of the queue is chosen; None: first come, first served
    serve   : fills free servers from the queue, in place of one job at a time; asked after each arrival too
    receive, vacate : in place of arriving at a server or the queue, and of giving the server back
    meter   : counts performances and operations
    setup_attended : whether a worker sets it up; setups : what its servers are set up for
    switched : told when the station closes (True) or opens
    clear   : told of each finished job that has to go on, which may leave its server; put_away : those that have

    has_seated : whether seated jobs are known; is_entry : whether a saturated source is kept from it
    luck, next_k : by task, of automatic runs
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
    is_entry: int
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
    meter: Annotated[Any, "Wear"]
    setup_attended: int
    setups: Annotated[Any, "Servers"]
    put_away: List[Job]
    subject: Any
    oven: Annotated[Any, "Oven"]
    belt: Annotated[Any, "Belt"]
    line: Annotated[Any, "Line"]
    line_at: int


@struct
class Job:
    """One unit of a product, or a lot.

    number          : n * sources + source, so that no two jobs have the same; n : its number in its source
    kind, since_s   : the state it is in, and since when
    step, operation : where it is on its route, or wants to be next; ``operation_rank`` goes into its rows,
                      ``gate`` is in front of the operation
    task_position   : how many of the tasks at the station are done; ``repeats_done`` of the one under way
    level           : 1 + rank of the task that stands for the one under way, where its height changes; 0: none yet
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
    level: int
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
    block: Annotated[Any, "JobBlocks"]


@struct
class JobBlocks:
    """The fields of each block stand together.

    taken : pieces that were taken out of it, a lot in a store; given : stations where it had its parts
    next_piece : of what it was split into the first; of a piece, the one behind it
    oven, oven_since_s : in whose queue it waits for a batch, since when; queue_key : by which its place there is found
    server, setups_left, stopped : see ``servers.KNOWN``; 1 + set-ups still to do, 0 where none was asked for; the
            work it was in when it lost its server
    shared : by number of shared work, 1 + how much of it was done at the first station; 0: nobody knows
    worst_at, worst : stations where somebody worked on it, and which share of his work he leaves good there, the least
    tools, doing : what it has, or wants; the performance with a hold under way
    coming, working : of its team, how many are on their way, and how many at work
    on_line, line_began_s, line_open : whether it is on a moving line, what the clock showed when it came onto it,
            and at the how many-th station something is left to be done of it, from 1 on
    line_late, line_ending : whether it is waited for at a limit, or at the end cannot leave
    helped, slower : whether somebody helps with it, and how much longer the rest would take one alone
    """

    reserved: int
    taken: int
    given: List[int]
    next_piece: Job
    oven: Annotated[Any, "Oven"]
    oven_since_s: float
    queue_key: Array[float]
    server: int
    setups_left: int
    stopped: Annotated[Any, "Stopped"]
    shared: Array[int]
    worst_at: List[int]
    worst: List[float]
    tools: Annotated[Any, "JobTools"]
    doing: Annotated[Any, "Doing"]
    coming: int
    working: int
    on_line: Call
    line_began_s: float
    line_open: int
    line_late: int
    line_ending: int
    helped: int
    slower: float


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
    stint: Annotated[Any, "Stint"]
    going: int
    staying: Job
    human: Annotated[Any, "Human"]
    dose: Annotated[Any, "Dose"]
    pace_shift: float
    in_free: int
    quality: Array[float]
    zone: Array[int]
    has_zone: int
    floater: int
    absence: float
    called_by: Any
    presence: Annotated[Any, "Presence"]
    tied: Job


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
class RouteStep:
    """An operation of a product, its rank, and the gate in front of it. position : by station, where it is in the list

    chances : streams that decide where jobs go on, by visit x sources + source
    """

    operation: int
    gate: Gate
    position: Array[int]
    way: Way
    chances: List[Stream]
