"""What jobs have of tools, what they want, and the crib where tools lie. See ``crib``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from opsim.engine.floor.machine import Array, Call, List, fresh, inlined, struct
from opsim.engine.floor.parts.state import Floor, Job
from opsim.engine.rules import tools

if TYPE_CHECKING:
    from opsim.engine.floor.parts.doings import Doing


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

    asked, found : who is gone through just now; spent : who waits no more, but may be gone through
    """

    free: Array[int]
    waiting: List[Want]
    calling: List[Want]
    changed: int
    asked: List[Want]
    found: List[Want]
    spent: List[Want]


_enough = inlined(tools.enough)
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
