"""How procedures ask for replications: of any model that answers, ours, SimPy's or another's.

What a procedure found: who is best, who was thrown out when and why, what is promised under which assumptions.

A study's answers as what procedures ask for.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from opsim.kpi.catalogue import LESS, MORE, AskedFigure, needs_postures
from opsim.kpi.targets import LimitText, bounds
from opsim.problems import did_you_mean
from opsim.results import Key
from opsim.study.compare import remedy
from opsim.study.jobs import Answers, Job, Point
from opsim.study.select.constants import check_confidence

AT_MOST, AT_LEAST = "<=", ">="


class Ask(NamedTuple):
    """Replications first, ..., upto - 1 of one system (numbered from 0)."""

    system: int
    first: int
    upto: int


Observe = Callable[[Sequence[Ask]], Sequence[np.ndarray]]
"""For each ask an array (upto - first, 1 + limits): the figure, then the figure of each limit; (n,) without limits.

Procedures ask for all that they need next at once, so that many processes can answer. The same replication of the same
system must always have the same values.
"""


def each(function: Callable[[int, int, int], np.ndarray]) -> Observe:
    """An Observe from ``function(system, first, upto)``, which answers one ask after the other."""
    return lambda asks: [function(*ask) for ask in asks]


@dataclass(frozen=True, slots=True)
class Limit:
    """The mean of a figure is to be at most (``<=``) or at least (``>=``) ``bound``.

    tolerance : a system whose mean is nearer to the bound than this may be called either, above 0
    """

    name: str
    bound: float
    tolerance: float
    sense: str = AT_MOST

    def __post_init__(self) -> None:
        if self.sense not in (AT_MOST, AT_LEAST):
            raise ValueError(f"limit on {self.name}: expected {AT_MOST} or {AT_LEAST}, found {self.sense!r}")
        if not (np.isfinite(self.bound) and self.tolerance > 0):
            raise ValueError(f"limit on {self.name}: expected a number and a tolerance above 0")

    def over(self, values: np.ndarray) -> np.ndarray:
        """By how much values are beyond the limit; below 0 where they are within it."""
        return values - self.bound if self.sense == AT_MOST else self.bound - values


class Answered:
    """What was asked so far of each system, as it came: ``values[i]`` is (n_i, 1 + limits)."""

    def __init__(self, observe: Observe, systems: Sequence[str], figures: Sequence[str]):
        self._observe, self._systems, self._figures = observe, tuple(systems), tuple(figures)
        self.values = [np.empty((0, len(figures))) for _ in systems]

    @property
    def n(self) -> tuple[int, ...]:
        return tuple(len(of) for of in self.values)

    def upto(self, wanted: Mapping[int, int]) -> None:
        """Ask, in one go, for what is missing of systems: number -> replications in all.

        Raises ValueError where an answer has another shape, or holds no number.
        """
        asks = [Ask(i, len(self.values[i]), upto) for i, upto in wanted.items() if upto > len(self.values[i])]
        if not asks:
            return
        for ask, found in zip(asks, self._observe(asks), strict=True):
            self.values[ask.system] = np.concatenate([self.values[ask.system], self._checked(ask, found)])

    def _checked(self, ask: Ask, found: np.ndarray) -> np.ndarray:
        wanted = (ask.upto - ask.first, len(self._figures))
        values = np.asarray(found, dtype=float)
        if values.ndim == 1 and wanted[1] == 1:
            values = values[:, None]
        if values.shape != wanted:
            raise ValueError(f"{self._systems[ask.system]}: expected values of shape {wanted}, found {values.shape}")
        if not np.isfinite(values).all():
            row, column = (int(place[0]) for place in np.nonzero(~np.isfinite(values)))
            named = f"{self._systems[ask.system]}: replication {ask.first + row}"
            raise ValueError(
                f"{named}: nothing was observed of {self._figures[column]}; a choice needs a number of each"
            )
        return values


def sign_of(better: str) -> float:
    """1 where more is better, -1 where less is."""
    if better not in (MORE, LESS):
        raise ValueError(f"better: expected {MORE!r} or {LESS!r}, found {better!r}")
    return 1.0 if better == MORE else -1.0


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
        from opsim.results import frame

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


@dataclass(frozen=True)
class Replications:
    """Which replication each ask means.

    first : the number of the first; apart : whether each point has numbers of its own, in turn, or all have the same
    """

    answers: Answers
    points: tuple[Point, ...]
    keys: tuple[Key, ...]
    first: int
    apart: bool = False

    def number(self, system: int, r: int) -> int:
        """The number of the r-th replication of a point."""
        return self.first + (r * len(self.points) + system if self.apart else r)

    def after(self, n: Sequence[int]) -> int:
        """A number beyond all of the first n of each point."""
        return max([self.first, *(self.number(i, r - 1) + 1 for i, r in enumerate(n) if r)])

    def observe(self, asks: Sequence[Ask]) -> list[np.ndarray]:
        """As procedures want it. Raises ValueError where a replication has no such figure."""
        jobs = [Job(self.points[a.system], self.number(a.system, r)) for a in asks for r in range(a.first, a.upto)]
        values = self.answers.values(jobs, self.keys)
        for row, column in np.argwhere(np.isnan(values))[:1]:
            raise ValueError(nothing_seen(jobs[row], self.keys[column]))
        return np.split(values, np.cumsum([a.upto - a.first for a in asks])[:-1])


def nothing_seen(job: Job, key: Key) -> str:
    """That a replication has no number of a figure, and why that may be."""
    why = "nobody knows the postures of its work" if needs_postures([key[0]]) else "nothing was observed"
    return f"{job.point.name}: {name_of(key)}: {why} in replication {job.replication}; a choice needs a number of each"


def key_of(asked: AskedFigure, keys: Sequence[Key]) -> Key:
    """The figure that is meant. ``rula_mean/worst`` is that of whoever has most, as nobody is called so.

    Raises ValueError where there is no such figure: the nearest one, or what to do about it.
    """
    named = [(asked.kpi, asked.subject, asked.part)]
    if asked.subject and not asked.part:
        named.append((asked.kpi, "", asked.subject))
    for one in named:
        for key in keys:
            if key[:3] == one:
                return key
    of = [name_of(key) for key in keys if key[0] == asked.kpi]
    hint = did_you_mean(name_of((*named[-1], "")), of, otherwise="there are") if of else remedy(asked.kpi, [])
    raise ValueError(f"no figure {asked.name!r} in this scenario; {hint}")


def name_of(key: Key) -> str:
    """As it is written: kpi, kpi/subject, kpi/part, kpi/subject/part."""
    return "/".join(filter(None, key[:3]))


def limit_of(text: LimitText, key: Key) -> Limit:
    """A limit in the unit of its figure. Raises ValueError where it is written in another."""
    bound, tolerance = bounds(text, key[3])
    return Limit(name_of(key), bound, tolerance, text.sense)
