"""What human effects do to one worker, without anything else on a floor: for models that are not ours."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

from opsim.engine.floor import worker
from opsim.engine.floor.build import Build
from opsim.engine.floor.human_state import level
from opsim.plan import Plan


class HumanSide:
    """Of the only worker of a floor on which nothing happens by itself."""

    def __init__(self, build: Build):
        self._floor: Any = build.floor
        self._worker: Any = build.workers[0]

    def level(self, now: float) -> float:
        """How tired he is, 0 (fresh, or where nobody tires) to 1."""
        self._floor.now = now
        return float(level(self._floor, self._worker.human))

    def drawn(self, now: float, task: int, k: int, drawn_s: float) -> tuple[float, float]:
        """Seconds of his k-th performance of a task, which begins now; and the shift that postures follow."""
        self._floor.now = now
        time_s = worker.human_drawn(self._floor, None, self._worker, task, k, drawn_s)
        return time_s, self._worker.pace_shift

    def works(self, now: float, task: int, k: int, until_s: float, done: float) -> None:
        """He works on his k-th of a task from now, ``done`` of which is done, until then if nothing comes between."""
        self._floor.now = now
        worker.works(self._floor, self._worker, task, until_s, done, k)

    def stops(self, now: float) -> None:
        """He is broken off."""
        self._floor.now = now
        worker.stops(self._floor, self._worker)


def human_side_of(plan: Plan, workforce: int, now: float) -> HumanSide:
    """Of a plan with one worker and human effects, from now on."""
    build = Build(replace(plan, rule="nearest", idle="stay", start_s=plan.human.start_s))
    build.floor.draws = SimpleNamespace(workforce=workforce)
    for one in build.answers:
        one.begin(build.floor)
    human = build.workers[0].human
    human.at_s = now
    if plan.human.fatigue is not None:
        human.state.at_s = now
    return HumanSide(build)
