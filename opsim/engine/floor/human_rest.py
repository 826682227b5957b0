"""Rest by need: who is free and too tired takes a rest, until he is not, or has to go."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import NOTHING, cast, line_of, step
from opsim.engine.floor.parts.events import alarm, cancel
from opsim.engine.floor.parts.humans import Effects, Human
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.state import DUTY, Floor, Worker
from opsim.engine.floor.parts.tiring import level, note_that_he_works
from opsim.engine.floor.worker import set_free, take_off
from opsim.engine.rules import CALENDAR
from opsim.log import BREAK, REST

FIRST = -2000
"""Before rotations, and whoever else sends anybody."""
_as_human = cast(Human)


def install(build: Any, effects: Any) -> None:
    """Rests, where people take them; asked before those who send anybody."""
    plan = build.plan.human
    if plan.rest is None or plan.fatigue is None:
        return
    effects.rests = 1
    build.hang(build.floor.dispatchers, look, effects, FIRST)
    build.hang(build.floor.dispatchers, look, effects)  # again: who is seen to stay on may be too tired


@step
def look(floor: Floor, effects: Effects) -> bool:
    """Who has to go rests no more; who has come free tired rests. True where something changed."""
    changed = False
    if effects.n_resting:
        for rank in range(floor.n_workers):
            worker = floor.workers[rank]
            if worker.human.resting and worker.limited[DUTY]:
                cancel(worker.human.resting)
                _over(floor, worker)
                note_that_he_works(floor, worker.human)  # and may be too tired still when he is back
                changed = True
    at = 0
    while at < len(effects.worked):
        worker = effects.worked[at]
        if worker.in_free and not worker.limited[DUTY]:
            worker.human.has_worked = 0
            del effects.worked[at]
            if _look_at(floor, worker):
                changed = True
        else:
            at += 1
    return changed


@step
def over(floor: Floor, event: Event) -> None:
    """He is rested."""
    human: Human = _as_human(event.subject)
    if human.resting is event:
        _over(floor, human.worker)


@step
def _look_at(floor: Floor, worker: Worker) -> bool:
    human = worker.human
    effects = human.effects
    if level(floor, human) <= effects.rest.above:
        return False
    effects.rest_line(floor, human)
    take_off(floor, worker, BREAK, REST)
    rank = floor.n_stations + floor.n_sources + worker.rank
    human.resting = alarm(floor, effects.answer, CALENDAR, rank, 3, _line_of_over, human)
    effects.n_resting += 1
    return True


@step
def _over(floor: Floor, worker: Worker) -> None:
    worker.human.resting = NOTHING
    worker.human.effects.n_resting -= 1
    set_free(floor, worker)


_line_of_over = line_of(over)
