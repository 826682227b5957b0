"""Gates at which cards are taken: who may come in, and why the others wait."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.card_lines import find_first
from opsim.engine.floor.machine import drop, inlined, step
from opsim.engine.floor.parts.events import stir_gate
from opsim.engine.floor.parts.gates import has_room, keeps_place, leads_to
from opsim.engine.floor.parts.loops import Guard, Loop, as_loop, is_outside, is_there, line_of_job, place_of
from opsim.engine.floor.parts.records import Source
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Gate, Job
from opsim.log import BLOCKED, GATE, HELD, NO_CARD, NO_CAUSE


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
