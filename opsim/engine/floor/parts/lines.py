"""What paced lines know: where they are in their takt, what their clocks are set to, and who walks along them."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, Call, List, struct
from opsim.engine.floor.parts.records import Claim, Event, Hook
from opsim.engine.floor.parts.state import Gate, Job, Station, Worker

AT_THE_END = 90
"""Among what is asked when an operation is done: the last, when nothing else has become of the job."""
TICK = -1
"""In place of a job's number, for what concerns the line as a whole."""


@struct
class Line:
    """See ``paced_line``, ``indexed_line`` and ``moving_line``. reach_m, start_s : see ``plan.LinePlan``

    move_line, stood_line : steps that move it, and that are told when it has come to stand, or to run
    act_line, stop_walks_line : of a moving line, see ``line_walks``; 0 where nobody walks along it
    changed : whether moving it changed something
    shown_s, runs_since_s, runs, pending : of its clock
    done, leaving : of an indexed line; late : jobs that are looked at just now
    n_late, n_ending : of a moving line, how many jobs are waited for, and how many at the end cannot leave
    along : by the rank of a worker, where on a moving line he is; with_job, spots, ways : those who are at a job, at
            none, and on their way to one, in the order in which they came to be so
    """

    moves: int
    move_line: Call
    stood_line: Call
    act_line: Call
    stop_walks_line: Call
    changed: int
    sends_on: int
    helps: int
    takt_s: float
    call_s: float
    speed_m_per_s: float
    exit_s: float
    n_stations: int
    stations: Array[Station]
    start_m: Array[float]
    start_s: Array[float]
    reach_m: Array[float]
    reach_s: Array[float]
    limit_s: Array[float]
    n_people: int
    people: Array[Worker]
    due: int
    open_s: float
    taken: int
    why: int
    since_s: float
    shown_s: float
    runs_since_s: float
    runs: int
    pending: List[Due]
    done: List[Job]
    leaving: int
    late: List[Job]
    n_late: int
    n_ending: int
    andon: Andon
    along: Array[Along]
    with_job: List[Along]
    spots: List[Along]
    ways: List[Along]


@struct
class Due:
    """What is to be done when the clock of a line shows a time. call_line : the step, which gets this

    rank, number : its place among the reports of that instant; job, at : what the step needs to know
    """

    line: Line
    at_s: float
    rank: int
    number: int
    call_line: Call
    job: Job
    at: int
    event: Event


@struct
class Along:
    """A worker and a moving line: the job he is at, the spot where he is, his way to a job (``line_walks``).

    has_job, job, began_s, at : the job he is at, when that came onto the line, and the how many-th station it is
    has_spot, place, from_m, to_m, since_s, strolls : see ``Spot``; version : of the spot, for who walks back to it
    has_way, way_job, way_at, way_from_m, way_since_s, downstream : see ``Way``
    """

    line: Line
    worker: Worker
    has_job: int
    job: Job
    began_s: float
    at: int
    has_spot: int
    place: int
    from_m: float
    to_m: float
    since_s: float
    strolls: int
    version: int
    has_way: int
    way_job: Job
    way_at: int
    way_from_m: float
    way_since_s: float
    downstream: int


@struct
class LineGate:
    """A gate onto a line. first : at its beginning, where one job comes in a takt; picked, lets : what it had."""

    line: Line
    gate: Gate
    first: int
    picked: Hook
    lets: Hook


@struct
class Andon:
    """See ``andon``. coming : by the number of a floater, the job he is on his way to

    asked : the jobs that wait when they are gone through
    """

    line: Line
    n_floaters: int
    floaters: Array[Worker]
    waiting: List[Claim]
    coming: Array[Job]
    left_s: float
    asked: List[Job]


@struct
class Helping:
    """Of a floor where somebody may help; what is known of each job that is helped with stands in its block."""

    there: int
