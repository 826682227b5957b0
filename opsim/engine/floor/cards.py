"""Cards: a job takes one before it enters a loop, waits outside while there is none, and gives it back at the end."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.card_gates import guard_of, take_back
from opsim.engine.floor.machine import give_items_back, step
from opsim.engine.floor.parts.loops import Loop, Loops, as_loop
from opsim.engine.floor.parts.state import Floor, Job, Station

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
