"""What a procedure found: who is best, who was thrown out when and why, what is promised under which assumptions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from opsim.study.select.asking import Answered, Limit, Observe, sign_of
from opsim.study.select.constants import check_confidence

CHOSEN, TIED, NONE_WITHIN, RAN_OUT, SPENT = "chosen", "tied", "none within", "ran out", "spent"
"""How it ended: one is left; several that are the same in every replication seen; nobody keeps the limits; replications
ran out first; the budget is spent (OCBA)."""
LEAST_FIRST = 5
"""Of fewer replications the spread is hardly known, and of counts it is 0 too often."""


@dataclass(frozen=True, slots=True)
class Out:
    """A system thrown out after ``n`` replications: beaten ``by`` another, or for the mean beyond a ``limit``."""

    system: str
    n: int
    by: str = ""
    limit: str = ""


@dataclass(frozen=True, slots=True)
class Stage:
    """Which systems are left after ``n`` replications of each that is left."""

    n: int
    left: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Selection:
    """One choice among systems.

    winner  : "" where there is none
    ended   : CHOSEN, TIED (``tied`` names the equals, the winner among them), NONE_WITHIN, RAN_OUT or SPENT
    stages  : from all systems to the last ones
    means   : of the figure, as the procedure weighs it, over the replications used
    limited : (systems, limits) means of the figures of limits, over the same replications
    n, asked : replications of each system that decided, and that were asked for
    needed  : of each system, where a procedure knows it; empty elsewhere
    promise, assumes : in words
    affordable : the indifference at which the replications allowed would have been enough for sure to tell who is
        better; nan: not known, or told
    open_pairs, open_limits : (system, system) that nobody told apart, (system, name of the limit) that may be kept or
        not, of those left (KN)
    posterior : chance that the winner is the best, or within the indifference of it, given what was seen (OCBA)
    values  : of each system (asked, 1 + limits), as observed
    """

    procedure: str
    systems: tuple[str, ...]
    winner: str
    ended: str
    stages: tuple[Stage, ...]
    out: tuple[Out, ...]
    means: tuple[float, ...]
    limited: tuple[tuple[float, ...], ...]
    n: tuple[int, ...]
    asked: tuple[int, ...]
    confidence: float
    indifference: float
    promise: str
    assumes: tuple[str, ...]
    tied: tuple[str, ...] = ()
    needed: tuple[int, ...] = ()
    affordable: float = float("nan")
    open_pairs: tuple[tuple[str, str], ...] = ()
    open_limits: tuple[tuple[str, str], ...] = ()
    posterior: tuple[float, float] | None = None
    values: tuple[np.ndarray, ...] = field(default=(), compare=False, repr=False)

    def to_frame(self) -> Any:
        """A pandas DataFrame, a row for each system. Raises ImportError where pandas is absent."""
        from opsim.frames import frame

        left = [system in self.left for system in self.systems]
        won = [system == self.winner for system in self.systems]
        return frame({"system": self.systems, "n": self.n, "mean": self.means, "left": left, "winner": won})

    @property
    def left(self) -> tuple[str, ...]:
        """The systems that nobody threw out."""
        return self.stages[-1].left


@dataclass(frozen=True, slots=True)
class Asked:
    """What every procedure is asked, checked once.

    indifference : differences of means below this do not matter, above 0
    confidence   : chance at least that the choice is right, above that of a guess
    first_stage  : replications of each system from which its spread is estimated, ``LEAST_FIRST`` or more
    most         : replications of each system at most
    """

    systems: tuple[str, ...]
    indifference: float
    confidence: float
    better: str
    first_stage: int
    most: int
    limits: tuple[Limit, ...] = ()

    def __post_init__(self) -> None:
        if len(self.systems) < 2:
            raise ValueError(f"expected two variants or more to choose from, found {len(self.systems)}")
        if len(set(self.systems)) < len(self.systems):
            raise ValueError(f"expected each variant once, found {', '.join(self.systems)}")
        if not (np.isfinite(self.indifference) and self.indifference > 0):
            raise ValueError(f"indifference: expected a number above 0, found {self.indifference:g}")
        if self.first_stage < LEAST_FIRST:
            found = f"expected {LEAST_FIRST} replications or more, found {self.first_stage}"
            raise ValueError(f"first stage: {found}; fewer say too little of the spread")
        if self.most < self.first_stage:
            raise ValueError(f"most: expected {self.first_stage} (the first stage) or more, found {self.most}")
        check_confidence(self.confidence, len(self.systems))
        sign_of(self.better)

    @property
    def k(self) -> int:
        return len(self.systems)

    def answered(self, observe: Observe) -> Answered:
        return Answered(observe, self.systems, ["the figure", *(limit.name for limit in self.limits)])


def plain_means(answered: Answered, n: Sequence[int]) -> tuple[tuple[float, ...], tuple[tuple[float, ...], ...]]:
    """Means of the figure, and of those of limits, over the first n of each system."""
    means = [of[:m].mean(axis=0) for of, m in zip(answered.values, n)]
    return tuple(float(one[0]) for one in means), tuple(tuple(map(float, one[1:])) for one in means)
