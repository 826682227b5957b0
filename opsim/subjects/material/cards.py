"""Cards: a job takes one before it enters a loop, waits outside while there is none, and gives it back at the end.

At a gate with cards, one of each line outside is asked, and everybody who is on the floor.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.floor_state import Floor, Source
from opsim.engine.floor.log_rows import job_now
from opsim.engine.floor.machine import Array, List, cast, drop, fresh, give_back, give_items_back, inlined, step, struct
from opsim.engine.floor.state import Claim, Gate, Job, Station
from opsim.log import BLOCKED, GATE, HELD, NO_CARD, NO_CAUSE
from opsim.subjects.routes.routing import has_room, is_there, keeps_place, leads_to, place_of, stir_gate


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


@step
def take_back(floor: Floor, loop: Loop, job: Job) -> None:
    """A card that a job has is given back; free it is when the job has none of the loop any more."""
    drop(job.cards, loop)
    if loop not in job.cards:
        loop.free += 1
        for one in loop.gates:
            if one.claims:
                stir_gate(floor, one)


@step
def lets(floor: Floor, guard: Guard, gate: Gate, source: Source) -> bool:
    """Whether the job that a source would make next would find its cards."""
    line = guard.lines[guard.number[source.next_product * guard.n_steps + source.next_step]]
    for i in range(line.n_needs):
        if not line.needs[i].free:
            return False
    return True


@step
def allows(floor: Floor, guard: Guard, job: Job) -> bool:
    """Whether the job has, or finds, all the cards it needs here: all of them at once, or none is taken."""
    line = line_of_job(guard, job)
    for i in range(line.n_needs):
        if not line.needs[i].free and line.needs[i] not in job.cards:
            return False
    return True


@step
def entered(floor: Floor, guard: Guard, job: Job) -> bool:
    """Take the cards; who has one keeps it. One that leaving the station here would give back stands twice."""
    line = line_of_job(guard, job)
    for i in range(line.n_needs):
        loop = line.needs[i]
        if loop not in job.cards:
            loop.free -= 1
            _take(floor, job, loop)
        if job.station.rank >= 0 and loop.back[job.station.rank] and _count(job, loop) == 1:
            _take(floor, job, loop)
    return True


@inlined
def _take(floor: Floor, job: Job, loop: Loop) -> None:
    job.cards.append(loop)
    if job.ahead:
        job.ahead.cards.append(loop)


@inlined
def _count(job: Job, loop: Loop) -> int:
    n = 0
    for one in job.cards:
        if one is loop:
            n += 1
    return n


@step
def given_up(floor: Floor, guard: Guard, job: Job) -> None:
    """The place that was kept for the job is given up, and the cards that were taken with it are given back."""
    while job.ahead.cards:
        take_back(floor, as_loop(job.ahead.cards.pop(0)), job)


@step
def pick(floor: Floor, guard: Guard, gate: Gate) -> int:
    """The number of the first claim that can be met, -1: none; jobs passed over are marked with what they wait for."""
    room = has_room(gate)
    find_first(floor, guard)
    for i in range(guard.n_lines):
        guard.lines[i].lacking = 0
    for claim in guard.asked:
        job = claim.job
        if job.ahead and job.ahead.station:
            return place_of(gate.claims, claim)
        lacks_card = not allows(floor, guard, job)
        if not lacks_card and (room or (leads_to(gate, job) and keeps_place(job))):
            return place_of(gate.claims, claim)
        _mark(floor, job, lacks_card)
        if lacks_card and is_outside(job):
            line_of_job(guard, job).lacking = 1
    _mark_new(floor, guard)
    return -1


@step
def _mark_new(floor: Floor, guard: Guard) -> None:
    """Mark those who came just now: they stand in lines whose first waits."""
    for one in guard.last:
        job = one.job
        if is_there(guard.gate.claims, one) and is_outside(job):
            _mark(floor, job, line_of_job(guard, job).lacking == 1)


@inlined
def _mark(floor: Floor, job: Job, lacks_card: bool) -> None:
    """A job outside, or blocked where it is, waits for a card or for room."""
    cause = job.cause
    if job.kind == HELD and job.station.rank < 0:
        cause = NO_CARD if lacks_card else GATE
    elif job.kind == BLOCKED:
        cause = NO_CARD if lacks_card else NO_CAUSE
    if job.cause != cause:
        job_now(floor, job, job.kind, cause)


def guard_of(build: Any, gate: Any, needs: dict[tuple[int, int], tuple[Any, ...]], wants: Any) -> Any:
    """A guard at a gate. needs : loops by (product, step); wants : all of these that come in by the gate."""
    guard = build.arena.new("Guard")
    guard.gate, guard.until_s, guard.n_lines = gate, -1.0, len(wants)
    products = build.plan.products
    guard.n_steps = n_steps = max(len(product.route) for product in products)
    number = [-1] * (n_steps * len(products))
    for at, (product, to) in enumerate(wants):
        number[product * n_steps + to] = at
    guard.number = build.ints(number)
    guard.lines = build.arena.array("CardLine", [_line(build, needs.get(want, ())) for want in wants])
    gate.pick, gate.lets = build.hook(pick, guard), build.hook(lets, guard)
    gate.given_up = build.hook(given_up, guard)
    build.hang(gate.allows, allows, guard)
    build.hang(gate.entered, entered, guard)
    return guard


def _line(build: Any, loops: tuple[Any, ...]) -> Any:
    made = build.arena.new("CardLine")
    made.n_needs, made.needs = len(loops), build.arena.array("Loop", loops)
    return made


Want = tuple[int, int]
"""(product rank, step of its route)"""


@step
def left_station(floor: Floor, loops: Loops, job: Job, station: Station) -> None:
    """Cards that are given back at the leaving of a station, one of each loop."""
    if not job.cards:
        return
    for i in range(loops.n):
        loop = loops.loops[i]
        if loop.back[station.rank] and loop in job.cards:
            take_back(floor, loop, job)


@step
def left_floor(floor: Floor, loops: Loops, job: Job) -> None:
    """All cards that it has."""
    while job.cards:
        take_back(floor, as_loop(job.cards[0]), job)
    give_items_back(floor, job.cards)


@step
def give_at_start(floor: Floor, loops: Loops) -> bool:
    """Pieces that lie at the end of a loop, or in one that ends on the way out, have their cards."""
    standing = loops.standing
    job = floor.first_job
    while job:
        at = len(standing)
        while at > 0 and job.number < standing[at - 1].number:
            at -= 1
        standing.insert(at, job)
        job = job.next_on_floor
    for one in standing:
        for j in range(loops.n):
            _give_at_start(floor, loops.loops[j], one)
    give_items_back(floor, standing)
    return True


@step
def _give_at_start(floor: Floor, loop: Loop, job: Job) -> None:
    at = job.station.rank
    if at >= 0 and loop.free and loop.wanted[job.product] and (not loop.n_back or loop.back[at]):
        loop.free -= 1
        job.cards.append(loop)


def install(build: Any) -> None:
    """Guard every gate at which a card is taken; pieces that lie inside a loop at the start have one."""
    plan, floor = build.plan, build.floor
    if not plan.cards:
        return
    made = [_loop(build, card) for card in plan.cards]
    for ranks, gate in build.gates.items():
        wants = _wants(plan, ranks)
        needs = {want: found for want in wants if (found := _needed(plan.cards, made, want))}
        if needs:
            guard_of(build, gate, needs, wants)
            for loop in {loop: None for found in needs.values() for loop in found}:
                loop.gates.append(gate)
    loops = build.arena.new("Loops")
    loops.n, loops.loops = len(made), build.arena.array("Loop", made)
    if any(card.back for card in plan.cards):
        build.hang(floor.left_station, left_station, loops)
    build.hang(floor.left_floor, left_floor, loops)
    build.hang(floor.starts, give_at_start, loops)


def _loop(build: Any, card: Any) -> Any:
    loop = build.arena.new("Loop")
    loop.free, loop.n_back = card.n, len(card.back)
    loop.back = build.ints(rank in card.back for rank in range(len(build.plan.stations)))
    loop.wanted = build.ints(bool(steps) for steps in card.steps)
    return loop


def _wants(plan: Any, ranks: tuple[int, ...]) -> list[Want]:
    """The products and steps that come in by a gate."""
    return [
        (product, step)
        for product, made in enumerate(plan.products)
        for step, operation in enumerate(made.route)
        if operation.stations == ranks
    ]


def _needed(cards: Any, loops: list[Any], want: Want) -> tuple[Any, ...]:
    product, step = want
    return tuple(loop for card, loop in zip(cards, loops) if step in card.steps[product])
