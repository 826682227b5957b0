"""Human effects on one worker in somebody's own model: the engine's, on a floor with nobody else on it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from opsim.own_luck import OwnLuck
from opsim.plan.human import HumanPlan

if TYPE_CHECKING:
    import simpy


class OwnHuman:
    """What ``humans.Human`` asks of a floor, and his answers; times are those of the environment.

    Between performances he rests, whatever he does.
    """

    humans: tuple[Any, ...] = ()

    def __init__(self, env: simpy.Environment, luck: OwnLuck, human: HumanPlan):
        from opsim.engine.simpy_engine.humans import install
        from opsim.ergonomics.shift.worker_plans import plan_of

        self._env = env
        self.plan = replace(plan_of({luck.worker: luck}, [luck.worker], luck.handling), human=human)
        self.draws = SimpleNamespace(workforce=luck.workforce)
        self.workers = (SimpleNamespace(rank=0, pace_shift=0.0, human=None),)
        install(self)  # type: ignore[arg-type]
        self._human = self.humans[0]
        self._rank = {task.name: rank for rank, task in enumerate(self.plan.tasks)}
        if self._human.tired is not None:
            self._human.tired.at_s = env.now

    @property
    def now(self) -> float:
        """Now."""
        return self._env.now

    @property
    def level(self) -> float:
        """How tired he is, 0 to 1."""
        return float(self._human.level(self.now))

    def drawn(self, task: str, k: int, drawn_s: float) -> tuple[float, float]:
        """Seconds of his k-th performance of a task, which begins now; and the shift that postures follow."""
        time_s = self._human.drawn(self, None, self._rank[task], k, drawn_s)
        return time_s, self.workers[0].pace_shift

    def works(self, task: str, k: int, until_s: float, done: float) -> None:
        """He works on his k-th of a task from now, ``done`` of which is done, until then if nothing comes between."""
        self._human.works(self.now, self._rank[task], until_s, done, k)

    def stops(self) -> None:
        """He is broken off."""
        self._human.stops(self.now)
