"""Models of human effects as they are, ours or anybody's; and what is asked about bodies in a run.

The compiled engine has its own writing of it: it stores numbers where this one has a state of the model.
"""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from typing import Any

from opsim.engine.floor.machine import more_of
from opsim.subjects.human.fatigue import tired
from opsim.subjects.human.human_state import Human, pass_to_now, posts_by_strain


def multiplier_of(model: Any, n: float) -> Any:
    """How long the n-th repetition takes, in times of the first."""
    return model.multiplier(n)


def work_of(model: Any, n: float) -> Any:
    """What n repetitions take, in times of the first."""
    return model.work(n)


def refuse_strangers(_plan: Any) -> None:
    """None is refused."""


def model_of(_build: Any, model: Any) -> Any:
    """The model itself."""
    return model


@more_of("Human")
class HumanWithState(Human):
    """state : see ``opsim.subjects.human.fatigue``."""

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
            from opsim.subjects.human.muscle_fatigue import Burdens

            burdens = Burdens(self.plan, floor.draws.workforce)
        for rank, human in enumerate(self.humans):
            human.state = tired(self.model, burdens, rank)
            human.tired = self.model.level(human.state.state)


def install_fatigue(build: Any, effects: Any) -> None:
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


class Bodies:
    """Of a floor that is set up. What was asked stays known until a replication has other people.

    rates : by worker, then task; NaN where nobody has asked
    """

    def __init__(self, build: Any):
        self.plan = build.plan
        self.rates = [[nan] * len(build.plan.tasks) for _ in build.plan.workers]
        self._orders: dict[int, list[int]] = {}
        self._workforce: int | None = None

    def begin(self, floor: Any) -> None:
        """A replication begins."""
        if floor.draws.workforce != self._workforce:
            self._workforce = floor.draws.workforce
            self._orders.clear()
            for row in self.rates:
                row[:] = [nan] * len(row)

    def rates_of(self, worker: int) -> list[float]:
        """A worker's row."""
        return self.rates[worker]

    def asks(self, answer: Callable[[int, Any], None]) -> Callable[[int, Any], None]:
        """What a floor can call."""
        return answer

    def answer_rate(self, worker: int, task: int) -> None:
        """How fast a worker gathers dose at a task."""
        self.rates[worker][task] = self._rates().per_s(worker, task)

    def answer_order(self, rotation: int, into: list[int]) -> None:
        """The posts of a rotation, the heaviest first, where the rules want them."""
        if rotation not in self._orders:
            plan = self.plan.rotations[rotation]
            self._orders[rotation] = posts_by_strain(self.plan, self._rates(), plan.posts, plan.workers)
        into[:] = self._orders[rotation]

    def _rates(self) -> Any:
        from opsim.ergonomics.shift.worst import dose_rates_of

        return dose_rates_of(self.plan, self._workforce or 0)


def bodies_of(build: Any) -> Bodies:
    """The one of a floor."""
    for one in build.answers:
        if isinstance(one, Bodies):
            return one
    build.answers.append(Bodies(build))
    found: Bodies = build.answers[-1]
    return found
