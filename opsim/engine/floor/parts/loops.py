"""Loops of cards, and the gates at which these are taken."""

from __future__ import annotations

from opsim.engine.floor.machine import Array, List, cast, inlined, struct
from opsim.engine.floor.parts.claims import is_before
from opsim.engine.floor.parts.records import Claim
from opsim.engine.floor.parts.state import Gate, Job


@struct
class Loop:
    """free : cards that no job has; gates : where they are taken; wanted : (P,) whether a product takes one

    n_back : stations at whose leaving they are given back, 0: on the way out; back : by station, whether it is one
    """

    free: int
    gates: List[Gate]
    wanted: Array[int]
    n_back: int
    back: Array[int]


@struct
class Loops:
    """All of them. standing : jobs on the floor at the start, by their numbers."""

    n: int
    loops: Array[Loop]
    standing: List[Job]


@struct
class CardLine:
    """Who wants the same at a gate, outside: a product's step. needs : n loops; lacking : whether a card is missing now

    claims : copies of theirs, in order; some of them may be gone
    """

    n_needs: int
    needs: Array[Loop]
    lacking: int
    claims: List[Claim]


@struct
class Guard:
    """Stands at a gate. n_steps : of the longest route; number : by product x n_steps + step, which line it is

    inside : copies of claims of jobs that come from a station, or have cards: each for itself
    until_s, last : up to when claims were looked at, and copies of those of that instant; asked : who is asked now
    """

    gate: Gate
    n_steps: int
    number: Array[int]
    n_lines: int
    lines: Array[CardLine]
    inside: List[Claim]
    until_s: float
    last: List[Claim]
    asked: List[Claim]


as_loop = cast(Loop)


@inlined
def line_of_job(guard: Guard, job: Job) -> CardLine:
    """Of those who want the same as a job: its product at the step that it claims a place for."""
    at = job.ahead.step if job.ahead else job.step
    return guard.lines[guard.number[job.product * guard.n_steps + at]]


@inlined
def is_outside(job: Job) -> bool:
    """Whether a job has neither a place nor a card yet: in this all who want the same are alike, but for their time."""
    return job.station.rank < 0 and not job.ahead and not job.cards


@inlined
def place_of(claims: List[Claim], claim: Claim) -> int:
    """Where a claim, or its copy, is in a list in order, or would be."""
    low, high = 0, len(claims)
    while low < high:
        middle = (low + high) >> 1
        if is_before(claims[middle], claim):
            low = middle + 1
        else:
            high = middle
    return low


@inlined
def is_there(claims: List[Claim], copy: Claim) -> bool:
    """Whether the claim that something is a copy of is among all claims of the gate, in order."""
    at = place_of(claims, copy)
    if at == len(claims):
        return False
    return claims[at].job is copy.job and not is_before(copy, claims[at])
