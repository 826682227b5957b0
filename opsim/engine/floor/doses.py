"""What each worker's body has gone through so far, for the rules that even it out."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.bodies import bodies_of
from opsim.engine.floor.humans import hang
from opsim.engine.floor.machine import inlined, step
from opsim.engine.floor.parts.doses import dose_so_far
from opsim.engine.floor.parts.keys import put
from opsim.engine.floor.parts.state import Floor, Job, Station, Worker
from opsim.engine.rules import allocation
from opsim.plan.evenness import evens_out

_less_gone_through = inlined(allocation.less_gone_through)


def install(build: Any) -> None:
    """Doses are counted where a rule of the plan asks for them; ``humans`` tells them who works."""
    if not evens_out(build.plan):
        return
    bodies = bodies_of(build)
    ask_rate, ask_order = bodies.asks(bodies.answer_rate), bodies.asks(bodies.answer_order)
    for worker in build.workers:
        dose = worker.dose = build.arena.new("Dose")
        dose.rates = bodies.rates_of(worker.rank)
        dose.ask_rate, dose.ask_order = ask_rate, ask_order
    if not build.floor.has_humans:
        hang(build)


@step
def by_dose(floor: Floor, worker: Worker, station: Station, job: Job) -> bool:
    """Who has gone through less so far."""
    put(floor, _less_gone_through(dose_so_far(floor, worker))[0])
    return True
