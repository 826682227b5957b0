"""Human effects on one worker in somebody's own model: those of a floor with nobody else on it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from opsim.own_luck import OwnLuck
from opsim.plan.human import HumanPlan

if TYPE_CHECKING:
    import simpy


class OwnHuman:
    """A floor with one worker; times are those of the environment. Between performances he rests, whatever he does."""

    def __init__(self, env: simpy.Environment, luck: OwnLuck, human: HumanPlan):
        from opsim.engine.in_model import human_side_of
        from opsim.ergonomics.shift.worker_plans import plan_of

        self._env = env
        self.plan = replace(plan_of({luck.worker: luck}, [luck.worker], luck.handling), human=human)
        self._side = human_side_of(self.plan, luck.workforce, env.now)
        self._rank = {task.name: rank for rank, task in enumerate(self.plan.tasks)}

    @property
    def level(self) -> float:
        """How tired he is, 0 to 1."""
        return self._side.level(self._env.now)

    def drawn(self, task: str, k: int, drawn_s: float) -> tuple[float, float]:
        """Seconds of his k-th performance of a task, which begins now; and the shift that postures follow."""
        return self._side.drawn(self._env.now, self._rank[task], k, drawn_s)

    def works(self, task: str, k: int, until_s: float, done: float) -> None:
        """He works on his k-th of a task from now, ``done`` of which is done, until then if nothing comes between."""
        self._side.works(self._env.now, self._rank[task], k, until_s, done)

    def stops(self) -> None:
        """He is broken off."""
        self._side.stops(self._env.now)
