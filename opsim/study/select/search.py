"""A search over many points: the seam for optimisers, and what a search is told."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

Changes = Mapping[str, Any]


class Search(Protocol):
    """An optimiser, asked and told in turn. The same questions and answers must always give the same questions."""

    def ask(self) -> Changes:
        """The next point to try: dotted path -> plain value. Several may be asked for before any is told."""

    def tell(self, changes: Changes, value: float | None, over: Sequence[float]) -> None:
        """What came of a point that was asked for, in the order of asking.

        value : mean of the figure, more is better; None where the point cannot be run
        over  : by how much each limit is broken, in its tolerances; at most 0 where it is kept
        """


@dataclass(frozen=True, slots=True)
class Trial:
    """A point that a search tried: means over its few replications, which flatter the best of many.

    over : beyond each limit, in its tolerances, so that limits of different units add up; below 0 where it is kept
    half_width : of the mean, nan of one replication; refused : why it could not be run, "" where it could
    """

    changes: Changes
    mean: float
    over: tuple[float, ...]
    refused: str = ""
    half_width: float = float("nan")

    @property
    def within(self) -> bool:
        """Whether it keeps the limits, as far as its few replications say."""
        return not self.refused and all(one <= 0 for one in self.over)


Look = Callable[[Sequence[Changes]], Sequence[Trial]]
"""Points -> what came of them, as many at once as are asked for."""


def searched(search: Search, look: Look, trials: int, at_once: int, sign: float) -> list[Trial]:
    """So many points tried, some at once; who is told of them and when does not depend on who computes them.

    sign : 1 where more of the figure is better, else -1
    """
    found: list[Trial] = []
    while len(found) < trials:
        asked = [search.ask() for _ in range(min(at_once, trials - len(found)))]
        for changes, trial in zip(asked, look(asked), strict=True):
            search.tell(changes, None if trial.refused else sign * trial.mean, trial.over)
            found.append(trial)
    return found


def best_trials(trials: Sequence[Trial], n: int, sign: float) -> list[Trial]:
    """The n best different points: those within the limits by their means, then those nearest in tolerances."""
    different = list({_said(trial): trial for trial in reversed(trials) if not trial.refused}.values())[::-1]
    worst = [float(np.sum(np.maximum(0.0, trial.over))) for trial in different]
    order = sorted(range(len(different)), key=lambda i: (worst[i], -sign * different[i].mean, i))
    return [different[i] for i in order[:n]]


def _said(trial: Trial) -> str:
    return repr(sorted(trial.changes.items()))
