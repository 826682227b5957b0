"""What a worker has behind him of each task: repetitions done, less what pauses took away.

Forgetting: how many repetitions somebody remembers after a pause.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, log1p
from typing import Any, ClassVar

from opsim.subjects.human.catalogue import Checked, parameter


class Memory:
    """The same in the engine, where it happens, and from the rows of a log.

    learning, forgetting : models of ``subjects.human``
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


@dataclass(frozen=True, slots=True)
class LearnForgetCurve(Checked):
    """LFCM: after q repetitions, which took t(q) without a pause, and a pause of d, alpha of them are remembered.

    As published, with T_x = T_1 x^-b, the time D after which all is forgotten, f the slope of forgetting and S what
    would have been done by the end of the pause had it been work:

        f     = b (1 - b) log q / log(1 + D / t(q))
        S     = q (1 + d / t(q))^(1 / (1 - b))
        alpha = q^(1 + f / b) S^(-f / b)

    Put into one another, b goes out: alpha = q^(1 - log(1 + d/t) / log(1 + D/t)), which any model of learning can use
    that knows t(q). At d = D one repetition is left: time is that of the first. From D on nothing is.
    Who has done it once or less forgets nothing before D. Pauses shorter than ``least_pause_s`` are no interruptions.
    Source: Jaber & Bonney (1996; 1997). D of a year and the least pause of a day are assumptions: breaks of
    1 to 82 days are what the model was compared with (Globerson, Levin & Shtub 1989).
    """

    does: ClassVar[str] = "a pause takes repetitions away again, the more the longer it is"
    source: ClassVar[str] = (
        "Jaber, M. Y. & Bonney, M. (1996). Production breaks and the learning curve: the forgetting phenomenon. "
        "Appl. Math. Model. 20, 162-169; (1997) 21, 523-531"
    )
    forgotten_in_s: float = parameter(
        31_536_000.0, "the pause after which all is forgotten (D)", unit="s", neutral=inf, above=0.0, endless=True
    )
    least_pause_s: float = parameter(86_400.0, "pauses shorter than this cost nothing", unit="s", at_least=0.0)

    def remembered(self, repetitions: float, pause_s: float, worked_s: float) -> float:
        """What is left of ``repetitions``, which took ``worked_s`` without a pause, after a pause."""
        if pause_s < self.least_pause_s or repetitions <= 0.0 or pause_s <= 0.0:
            return repetitions
        if pause_s >= self.forgotten_in_s:
            return 0.0
        if repetitions <= 1.0:
            return repetitions
        return repetitions ** (1.0 - log1p(pause_s / worked_s) / log1p(self.forgotten_in_s / worked_s))
