"""What a worker has behind him of each task: repetitions done, less what pauses took away."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Memory:
    """The same in the engine, where it happens, and from the rows of a log.

    learning, forgetting : models of ``opsim.human``; forgetting may be None
    experience : by task, repetitions behind him at the start; empty: none
    first_s    : mean time of the first repetition of a task, by task
    """

    __slots__ = ("_at", "_first_s", "_forgetting", "_last_s", "_learning", "units")

    def __init__(self, learning: Any, forgetting: Any, experience: tuple[float, ...], first_s: Callable[[int], float]):
        self._learning, self._forgetting, self._first_s = learning, forgetting, first_s
        self.units: dict[int, float] = {task: done for task, done in enumerate(experience) if done}
        self._last_s: dict[int, float] = {}
        self._at = -1

    def begins(self, task: int, now: float, so_many: int = 1) -> float:
        """Which repetition of a task begins now: what he remembers, and one. ``so_many``: the last of several."""
        behind = self.units.get(task, 0.0)
        last_s = self._last_s.get(task)
        if self._forgetting is not None and last_s is not None:
            behind = self._remembered(task, behind, now - last_s)
        self.units[task] = behind + so_many
        return behind + so_many

    def works(self, now: float, task: int, until_s: float) -> None:
        """He works on a task from now until then, if nothing comes between."""
        self._at, self._last_s[task] = task, until_s

    def stops(self, now: float) -> None:
        """What he worked on is broken off."""
        if self._at >= 0:
            self._last_s[self._at] = min(now, self._last_s[self._at])

    def _remembered(self, task: int, behind: float, pause_s: float) -> float:
        if pause_s < self._forgetting.least_pause_s or behind <= 0.0:  # NOTE: the mean time is asked for rarely
            return behind
        worked_s = self._first_s(task) * self._learning.work(behind)
        return self._forgetting.remembered(behind, pause_s, worked_s)


def first_times(plan: Any, learning: Any) -> Callable[[int], float]:
    """Mean seconds of the first repetition of each task, at rating 1, each found once."""
    known: dict[int, float] = {}

    def first_s(task: int) -> float:
        if task not in known:
            known[task] = plan.tasks[task].model.mean_duration_s() * learning.multiplier(1.0)
        return known[task]

    return first_s


def experience_of(plan: Any, worker: int) -> tuple[float, ...]:
    """Repetitions behind a worker at the start, by task; empty: none."""
    experience = plan.human.experience
    return experience[worker] if experience else ()
