"""What a worker has behind him of each task: repetitions done, less what pauses took away."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class Memory:
    """The same in the engine, where it happens, and from the rows of a log.

    learning, forgetting : models of ``opsim.human``
    experience : by task, repetitions behind him at the start; empty: none
    first_s    : mean time of the first repetition of a task, by task

    A performance counts once any of it is done: one that is broken off in the instant in which it begins leaves no row.
    """

    __slots__ = ("_asked", "_at", "_first_s", "_forgetting", "_last_s", "_learning", "units")

    def __init__(self, learning: Any, forgetting: Any, experience: tuple[float, ...], first_s: Callable[[int], float]):
        self._learning, self._forgetting, self._first_s = learning, forgetting, first_s
        self.units: dict[int, float] = {task: done for task, done in enumerate(experience) if done}
        self._last_s: dict[int, float] = {}
        self._asked: tuple[int, int, float] | None = None
        self._at: tuple[int, float, float] | None = None

    def begins(self, task: int, k: int, now: float) -> float:
        """Which repetition of a task his k-th is if he begins it now: what he remembers, and one."""
        self._pass_to(now)
        behind = self.units.get(task, 0.0)
        last_s = self._last_s.get(task)
        if last_s is not None:
            behind = self._remembered(task, behind, now - last_s)
        self._asked, self._at = (task, k, behind + 1.0), None
        return behind + 1.0

    def works(self, now: float, task: int, k: int, until_s: float) -> None:
        """He works on his k-th of a task from now until then, if nothing comes between."""
        self._pass_to(now)
        if self._asked is not None and self._asked[:2] != (task, k):
            self._asked = None  # it came to nothing
        self._at = task, now, until_s

    def stops(self, now: float) -> None:
        """What he worked on is broken off."""
        self._pass_to(now)
        self._at = None

    def _pass_to(self, now: float) -> None:
        """What he has worked on until now counts; of one performance, once."""
        if self._at is None or now <= self._at[1]:
            return
        task, _, until_s = self._at
        self._last_s[task] = min(now, until_s)
        if self._asked is not None:
            self.units[task], self._asked = self._asked[2], None

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
