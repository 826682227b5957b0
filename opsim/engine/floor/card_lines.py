"""Who is to be asked at a gate with cards: one of each line outside, and everybody who is on the floor."""

from __future__ import annotations

from opsim.engine.floor.machine import List, fresh, give_back, inlined, step
from opsim.engine.floor.parts.loops import Guard, is_outside, is_there, line_of_job, place_of
from opsim.engine.floor.parts.records import Claim
from opsim.engine.floor.parts.state import Floor

_new_claim, _forget_claim = fresh(Claim), give_back(Claim)


@inlined
def _copy(floor: Floor, claim: Claim) -> Claim:
    made: Claim = _new_claim(floor)
    made.before, made.since_s, made.number, made.job = claim.before, claim.since_s, claim.number, claim.job
    return made


@inlined
def _put(floor: Floor, claims: List[Claim], claim: Claim) -> None:
    claims.insert(place_of(claims, claim), claim)


@step
def find_first(floor: Floor, guard: Guard) -> None:
    """Put the claims that decide which one is met into ``guard.asked``, in order. The gate has claims."""
    claims, inside, asked = guard.gate.claims, guard.inside, guard.asked
    _look(floor, guard)
    asked.clear()
    at = 0
    while at < len(inside):
        if is_there(claims, inside[at]):
            asked.append(inside[at])
            at += 1
        else:
            _forget_claim(floor, inside[at])
            del inside[at]
    for i in range(guard.n_lines):
        line = guard.lines[i].claims
        while line and not is_there(claims, line[0]):
            _forget_claim(floor, line.pop(0))
        if line:
            _put(floor, asked, line[0])


@step
def _look(floor: Floor, guard: Guard) -> None:
    """Put claims that were not looked at before where they belong: of each priority, they are the last."""
    claims = guard.gate.claims
    if floor.now != guard.until_s:
        while guard.last:
            _forget_claim(floor, guard.last.pop(0))
    at = len(claims) - 1
    while at >= 0:
        claim = claims[at]
        if claim.since_s < guard.until_s:  # and so are all before it of the same priority
            at = _first_of(claims, claim.before) - 1
            continue
        if not claim.seen:
            _look_at(floor, guard, claim)
        at -= 1
    guard.until_s = floor.now


@inlined
def _first_of(claims: List[Claim], before: float) -> int:
    """Where the claims of a priority begin."""
    low, high = 0, len(claims)
    while low < high:
        middle = (low + high) >> 1
        if claims[middle].before < before:
            low = middle + 1
        else:
            high = middle
    return low


@inlined
def _look_at(floor: Floor, guard: Guard, claim: Claim) -> None:
    claim.seen = 1
    if claim.since_s == floor.now:
        guard.last.append(_copy(floor, claim))
    if is_outside(claim.job):
        _put(floor, line_of_job(guard, claim.job).claims, _copy(floor, claim))
    else:
        _put(floor, guard.inside, _copy(floor, claim))
