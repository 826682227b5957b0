"""What jobs have of tools and what they want, performances in which one is held, and the rows that tell of it."""

from __future__ import annotations

from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.log_rows import name_job, new_row
from opsim.engine.floor.machine import Array, Call, List, fresh, inlined, step, struct
from opsim.engine.floor.records import Stream
from opsim.engine.floor.state import Job, Worker
from opsim.log import HELD, NO_TOOL, TOOL


@struct
class Doing:
    """A performance with a hold, from where it has come to. worker, task, k : whose, of what, and which

    left_s, start_s, end_s : seconds of work to its end, and to the moments of taking the tool and of giving it back
    stretch_s : seconds of work to where the stretch under way ends
    at_work : whether it is under way now; begun : whether it was ever
    before  : how much of the task was done when it was drawn; drawn : before human effects, with the moments as shares

    drawn_s, drawn_start, drawn_end : what was drawn, before human effects.
    """

    worker: Worker
    task: int
    k: int
    left_s: float
    start_s: float
    end_s: float
    before: float
    drawn_s: float
    drawn_start: float
    drawn_end: float
    stretch_s: float
    at_work: int
    begun: int


@struct
class Holds:
    """of_workers, of_stations : streams by worker, or station, x tasks + task; start, end : shares that were drawn last

    wanted : by task, the tool that is held
    """

    of_workers: Array[Stream]
    of_stations: Array[Stream]
    start: float
    end: float
    wanted: Array[Want]


@struct
class Grip:
    """Tools of a job, for a purpose. needs : n_needs pairs of a tool and how many; task : -1 the station itself."""

    purpose: int
    n_needs: int
    needs: Array[int]
    task: int
    since_s: float
    station: int
    operation: int


@struct
class Want:
    """Tools that a job wants. go_on_line : the step that follows when they are there; doing : what waits for them

    before, since_s : with the job's number, its place among those who wait; at_once : they are the job's as soon
        as they are free; else when a worker sets out with them
    """

    job: Job
    purpose: int
    n_needs: int
    needs: Array[int]
    task: int
    go_on_line: Call
    at_once: int
    doing: Doing
    before: float
    since_s: float


@struct
class JobTools:
    """Of one job. wanted, since_s : purposes, and since when for each; calling : for a worker with tools

    known : whether it had, wanted or called for some at the station where it is
    """

    known: int
    grips: List[Grip]
    wanted: List[int]
    since_s: List[float]
    calling: Want


@struct
class Crib:
    """free : of each tool, how many; waiting : in the order of claims; calling : in the order of their first calls

    shared : of each tool, whether it is somebody else's too; then it is not free as it is given back, but ``returned``
    asked, found : who is gone through just now; spent : who waits no more, but may be gone through
    """

    free: Array[int]
    shared: Array[int]
    returned: Array[int]
    waiting: List[Want]
    calling: List[Want]
    changed: int
    asked: List[Want]
    found: List[Want]
    spent: List[Want]


_enough = inlined(rules.enough)
_new_tools = fresh(JobTools)


@inlined
def tools_of(floor: Floor, job: Job) -> JobTools:
    """What the job has, or wants, of tools."""
    if not job.block.tools:
        job.block.tools = _new_tools(floor)
    return job.block.tools


@inlined
def grip_at(job: Job, purpose: int) -> int:
    """The number of what the job has for a purpose; -1: it has nothing for that."""
    if job.block.tools:
        grips = job.block.tools.grips
        for at in range(len(grips)):
            if grips[at].purpose == purpose:
                return at
    return -1


@inlined
def is_free(crib: Crib, n_needs: int, needs: Array[int]) -> bool:
    """Whether all that is needed is there."""
    for i in range(n_needs):
        if not _enough(crib.free[needs[2 * i]], needs[2 * i + 1]):
            return False
    return True


@inlined
def is_known(job: Job) -> bool:
    """Whether the job had, wanted or called for tools at the station where it is."""
    if job.block.tools:
        return job.block.tools.known == 1
    return False


@step
def log_grip(floor: Floor, job: Job, grip: Grip) -> None:
    """Write what a job had until now: a row for each piece, with the number of the tool as its k."""
    if floor.now <= grip.since_s:
        return
    for i in range(grip.n_needs):
        for _ in range(grip.needs[2 * i + 1]):
            row = new_row(floor, TOOL, grip.since_s)
            name_job(row, job)
            row.station, row.operation, row.task = grip.station, grip.operation, grip.task
            row.k = grip.needs[2 * i]


@step
def log_wait(floor: Floor, job: Job, task: int) -> None:
    """Write a job's wait for tools until now, with the task whose tools were missing."""
    if floor.now > job.since_s and job.station.rank >= 0:
        row = new_row(floor, HELD, job.since_s)
        name_job(row, job)
        row.station, row.task, row.cause = job.station.rank, task, NO_TOOL
        job.since_s = floor.now
