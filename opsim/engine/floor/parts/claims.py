"""Claims: where jobs wait for something, in the order in which they are served."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, List, fresh, give_back, inlined
from opsim.engine.floor.parts.records import Claim
from opsim.engine.floor.parts.state import Floor, Job

new_claim = fresh(Claim)
_forget = give_back(Claim)


@inlined
def is_before(one: Claim, other: Claim) -> bool:
    """Whether one is served before another."""
    if one.before != other.before:
        return one.before < other.before
    if one.since_s != other.since_s:
        return one.since_s < other.since_s
    return one.number < other.number


@inlined
def put_claim(floor: Floor, claims: List[Claim], job: Job, since_s: float) -> None:
    """A job puts a claim down, at its place in the order."""
    claim: Claim = new_claim(floor)
    claim.before, claim.since_s, claim.number, claim.job = -job.priority, since_s, job.number, job
    at = len(claims)
    while at > 0 and is_before(claim, claims[at - 1]):
        at -= 1
    claims.insert(at, claim)


@inlined
def take_claim(floor: Floor, claims: List[Claim], at: int) -> None:
    """The claim number ``at`` is met, or given up."""
    claim = claims[at]
    del claims[at]
    claim.job = NOTHING
    _forget(floor, claim)


@inlined
def claim_at(claims: List[Claim], job: Job) -> int:
    """The number of a job's first claim; -1: it has none."""
    for at in range(len(claims)):
        if claims[at].job is job:
            return at
    return -1


@inlined
def give_up_claims(floor: Floor, claims: List[Claim], job: Job) -> bool:
    """The job claims nothing there any more; whether it did."""
    found = False
    for at in range(len(claims) - 1, -1, -1):
        if claims[at].job is job:
            take_claim(floor, claims, at)
            found = True
    return found
