"""Fatigue on the floor: a shift of every log time that a worker draws himself, by how tired he is then.

The models are those of ``opsim.human``, or anybody's. The compiled engine has its own writing of it: it stores numbers
where this one has a state of the model.
"""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine.structs import more_of
from opsim.engine.floor.parts.humans import Human
from opsim.engine.floor.parts.tiring import pass_to_now
from opsim.human.tired import tired


@more_of("Human")
class HumanWithState(Human):
    """state : see ``opsim.human.tired``."""

    __slots__ = ("state",)


class _Fresh:
    """Everybody is fresh as a replication begins."""

    def __init__(self, build: Any, model: Any):
        self.plan, self.model = build.plan, model
        self.humans = [worker.human for worker in build.workers]

    def begin(self, floor: Any) -> None:
        """A replication begins."""
        burdens = None
        if self.model.needs_burden:
            from opsim.human.burden import Burdens

            burdens = Burdens(self.plan, floor.draws.workforce)
        for rank, human in enumerate(self.humans):
            human.state = tired(self.model, burdens, rank)
            human.tired = self.model.level(human.state.state)


def install(build: Any, effects: Any) -> None:
    """A state at every worker, where people tire."""
    model = build.plan.human.fatigue
    if model is None:
        return
    effects.pass_line, effects.rest_line = pass_on, has_to_rest
    build.hang(effects.shifts, slowed)
    build.answers.append(_Fresh(build, model))


def slowed(floor: Any, worker: Any, _station: Any) -> None:
    """By how much his log time shifts now."""
    human = worker.human
    pass_to_now(floor, human)
    human.effects.answer = human.effects.fatigue.shift(human.tired)


def pass_on(floor: Any, human: Any) -> None:
    """Time goes on for him until now, which is later than when it did last."""
    state = human.state
    state.is_at(human.task, human.begun_s, human.until_s, human.done)
    state.pass_to(floor.now)
    human.at_s = floor.now
    if human.task >= 0 and floor.now >= human.until_s:
        human.task = -1
    human.tired = state.model.level(state.state)


def has_to_rest(_floor: Any, human: Any) -> None:
    """For how many seconds, until he is rested enough."""
    effects = human.effects
    effects.answer = effects.fatigue.rest_to_s(human.state.state, effects.rest.until)
