"""Fatigue on the floor: a shift of every log time that a worker draws himself, by how tired he is then."""

from __future__ import annotations

from typing import Any

from opsim.engine.fast_engine import human_muscles
from opsim.engine.fast_engine.bodies import bodies_of
from opsim.engine.fast_engine.machine import call_out, inlined, step
from opsim.engine.fast_engine.parts.humans import Human
from opsim.engine.fast_engine.parts.state import Floor, Station, Worker
from opsim.engine.fast_engine.parts.tiring import pass_to_now
from opsim.human.lffrm import Lffrm
from opsim.human.three_compartment import ThreeCompartment
from opsim.human.tired import piece

_piece = inlined(piece)
_shift: Any = inlined(Lffrm.shift)
_passed: Any = inlined(Lffrm.passed)
_rested: Any = inlined(Lffrm.rested)
_rest_to_s: Any = inlined(Lffrm.rest_to_s)


def install(build: Any, effects: Any) -> None:
    """A state at every worker, where people tire."""
    model = build.plan.human.fatigue
    if model is None:
        return
    if isinstance(model, ThreeCompartment):
        human_muscles.install(build, effects)
        return
    effects.pass_line, effects.rest_line = build.line(pass_on), build.line(has_to_rest)
    build.hang(effects.shifts, slowed)
    bodies = bodies_of(build) if model.needs_burden else None
    even = build.floats([1.0] * len(build.tasks)) if bodies is None else 0
    for worker in build.workers:
        worker.human.heaviness = even if bodies is None else bodies.heaviness_of(worker.rank)
    if bodies is not None:
        effects.ask_burden = bodies.asks(bodies.answer_heaviness)


@step
def slowed(floor: Floor, worker: Worker, station: Station) -> None:
    """By how much his log time shifts now."""
    human = worker.human
    pass_to_now(floor, human)
    human.effects.answer = _shift(human.effects.fatigue, human.tired)


@step
def pass_on(floor: Floor, human: Human) -> None:
    """Time goes on for him until now, which is later than when it did last."""
    model, at_s = human.effects.fatigue, human.at_s
    human.at_s = floor.now
    task = human.task
    if task < 0:
        human.tired = _rested(model, human.tired, floor.now - at_s)
        return
    first, last, work_s, rest_s = _piece(at_s, floor.now, human.begun_s, human.until_s, human.done)
    if floor.now >= human.until_s:
        human.task = -1
    if human.heaviness[task] != human.heaviness[task]:  # NaN: nobody has asked yet
        call_out(human.effects.ask_burden, human.worker.rank, task)
    human.tired = _passed(model, human.tired, human.heaviness[task], first, last, work_s, rest_s)


@step
def has_to_rest(floor: Floor, human: Human) -> None:
    """For how many seconds, until he is rested enough."""
    effects = human.effects
    effects.answer = _rest_to_s(effects.fatigue, human.tired, effects.rest.until)
