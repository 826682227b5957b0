"""Cards: a job takes one before it enters a loop, waits outside while there is none, and gives it back at the end."""

from __future__ import annotations

from opsim.engine.simpy_engine.card_gates import Guard, Loop
from opsim.engine.simpy_engine.card_lines import Want
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import OUTSIDE, Gate, Job, Station


def install(floor: Floor) -> None:
    """Guard every gate at which a card is taken; pieces that lie inside a loop at the start have one."""
    if not floor.plan.cards:
        return
    loops = [Loop(card, card.n) for card in floor.plan.cards]
    for gate in floor.gates.values():
        wants = _wants(floor, gate)
        needs = {want: found for want in wants if (found := _needed(loops, want))}
        if needs:
            guard = Guard(floor, gate, needs)
            gate.allows, gate.entered, gate.given_up = guard.allows, guard.entered, guard.given_up
            gate.pick, gate.lets = guard.pick, guard.lets
            for loop in {id(loop): loop for found in needs.values() for loop in found}.values():
                loop.gates.append(gate)
    if any(card.back for card in floor.plan.cards):
        floor.left_station.append(_left_station)
    floor.left_floor.append(_left_floor)
    for job in sorted(floor.jobs.values(), key=lambda job: job.number):
        _give_at_start(job, loops)


def _wants(floor: Floor, gate: Gate) -> list[Want]:
    """The products and steps that come in by a gate."""
    return [
        (product, step)
        for product, steps in enumerate(floor.steps)
        for step, (_, _, before) in enumerate(steps)
        if before is gate
    ]


def _needed(loops: list[Loop], want: Want) -> tuple[Loop, ...]:
    product, step = want
    return tuple(loop for loop in loops if step in loop.plan.steps[product])


def _left_station(floor: Floor, job: Job, station: Station) -> None:
    for loop in dict.fromkeys(job.cards) if job.cards else ():
        if station.rank in loop.plan.back:
            loop.take_back(floor, job)


def _left_floor(floor: Floor, job: Job) -> None:
    for loop in list(job.cards or ()):
        loop.take_back(floor, job)


def _give_at_start(job: Job, loops: list[Loop]) -> None:
    """A piece that lies at the end of a loop, or in one that ends on the way out, has its card."""
    for loop in loops:
        inside = job.station is not OUTSIDE and (not loop.plan.back or job.station.rank in loop.plan.back)
        if inside and loop.free and loop.plan.steps[job.product]:
            loop.free -= 1
            job.cards = [*(job.cards or ()), loop]
