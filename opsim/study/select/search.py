"""A search over many points: the seam for optimisers, and what a search is told.

optuna as a Search: its tree-structured Parzen estimator, seeded by a named stream.

Among which points a choice is made: variants of a file, or combinations of what is varied.

What a study of which is best found, and which replications it looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from math import prod
from typing import Any, Protocol

import numpy as np

from opsim.problems import did_you_mean, shown
from opsim.results import Key
from opsim.scenario.schema.sweep import is_whole
from opsim.streams import stream
from opsim.study.intervals import Interval
from opsim.study.jobs import Point
from opsim.study.select.constants import check_confidence
from opsim.study.select.selection import Limit, Selection
from opsim.study.sweep.factors import Factor, factors_of

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


STARTED = 10
"""Points that are drawn at random before the estimator says where to look; fewer where few are tried."""


class OptunaSearch:
    """Looks for the best point of some factors. Source: Watanabe 2023, arXiv:2304.11127 (the estimator); limits:
    Watanabe & Hutter 2023, IJCAI (constrained TPE).
    """

    def __init__(self, factors: Sequence[Factor], seed: int, trials: int):
        """Raises ValueError where optuna is not installed."""
        try:
            import optuna
        except ImportError:
            raise ValueError(
                "a search needs optuna, which is not installed; 'pip install opsim[search]' brings it"
            ) from None
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        self._factors = {factor.path: factor for factor in factors}
        self._spaces = {factor.path: _space(factor) for factor in factors}
        self._failed = optuna.trial.TrialState.FAIL
        sampler = optuna.samplers.TPESampler(
            seed=int(stream(seed, 0, "select", "search").integers(2**31)),
            n_startup_trials=min(STARTED, max(2, trials // 3)),
            constant_liar=True,
        )
        self._study = optuna.create_study(direction="maximize", sampler=sampler)
        self._open: list[Any] = []

    def ask(self) -> Changes:
        """The next point to try."""
        trial = self._study.ask(self._spaces)
        self._open.append(trial)
        return {path: _value(self._factors[path], said) for path, said in trial.params.items()}

    def tell(self, changes: Changes, value: float | None, over: Sequence[float]) -> None:
        """What came of the first point that was asked for and not told yet."""
        trial = self._open.pop(0)
        for place, one in enumerate(over):
            trial.set_constraint(f"limit {place}", float(one))
        if value is None:
            self._study.tell(trial, state=self._failed)
        else:
            self._study.tell(trial, value)


def _space(factor: Factor) -> Any:
    """Ranges as shares of themselves, whole numbers and lists of numbers by rank, other lists by number."""
    from optuna.distributions import CategoricalDistribution, FloatDistribution, IntDistribution

    if factor.is_range:
        low, high = factor.values
        return IntDistribution(low, high) if is_whole(low, high) else FloatDistribution(0.0, 1.0)
    if factor.is_number:
        return IntDistribution(0, len(factor.values) - 1)
    return CategoricalDistribution(tuple(range(len(factor.values))))


def _value(factor: Factor, said: float) -> Any:
    if not factor.is_range:
        ordered = sorted(factor.values, key=factor.number) if factor.is_number else factor.values
        return ordered[int(said)]
    return int(said) if is_whole(*factor.values) else factor.at(float(said))


MOST_POINTS = 2000
USUAL_TRIALS = 60


@dataclass(frozen=True)
class Candidates:
    """points : to choose from, empty before a search has found them; base : what the chosen one is compared with."""

    points: tuple[Point, ...]
    base: Point
    factors: tuple[Factor, ...] = ()
    trials: int = 0


def candidates_of(block: Any, siblings: Sequence[str], variant: str) -> Candidates:
    """block : of ``studies: select:``; siblings : all variants of the file; variant : the one to start from.

    Raises ValueError: no such variant, only one, too many combinations, a confidence that a guess has too.
    """
    if block.vary is None:
        found = _variants(block, siblings, variant)
    else:
        _known([block.base] if block.base else [], siblings)
        base = Point(block.base or variant, {}, block.base or variant)
        factors = factors_of(block.vary)
        if block.search or block.trials:
            found = _to_search(block, factors, base)
        else:
            found = Candidates(tuple(_grid(factors, variant)), base, factors)
    n = min(block.finalists, found.trials) if found.trials else len(found.points)
    if n > 1:
        check_confidence(block.confidence, n)
    return found


def _variants(block: Any, siblings: Sequence[str], variant: str) -> Candidates:
    names = list(dict.fromkeys(block.variants or siblings))
    _known([*names, *([block.base] if block.base else [])], siblings)
    if len(names) < 2:
        hint = "name several with --among, add some under 'scenarios:', or vary something with --vary"
        raise ValueError(f"only {names[0]!r} is there: nothing to choose from; {hint}")
    base = block.base or variant
    return Candidates(tuple(Point(name, {}, name) for name in names), Point(base, {}, base))


def _known(names: Sequence[str], siblings: Sequence[str]) -> None:
    wrong = [name for name in names if name not in siblings]
    if wrong:
        hints = [f"no variant {shown(one)}; {did_you_mean(one, siblings, otherwise='there are')}" for one in wrong]
        raise ValueError("\n".join(hints))


def _grid(factors: Sequence[Factor], variant: str) -> list[Point]:
    ranges = [factor.path for factor in factors if factor.is_range and factor.levels is None]
    if ranges:
        hint = "list values, or let an optimiser look with --search"
        raise ValueError(f"{', '.join(ranges)}: a range has no end of values to choose from; {hint}")
    n = _combinations(factors)
    if n < 2:
        raise ValueError("only one combination: nothing to choose from; give two values or more of something")
    if n > MOST_POINTS:
        raise ValueError(
            f"{n:,} combinations, at most {MOST_POINTS:,} are run one by one; take --search, or fewer values"
        )
    return [named(factors, values, variant) for values in product(*(factor.grid_values() for factor in factors))]


def named(factors: Sequence[Factor], values: Sequence[Any], variant: str) -> Point:
    """The point with these values, called by them."""
    return Point(called(factors, values), {factor.path: value for factor, value in zip(factors, values)}, variant)


def called(factors: Sequence[Factor], values: Sequence[Any]) -> str:
    """``saw 2, every 40 s``: no more of each path than tells it from the others."""
    names = short_names([factor.path for factor in factors])
    return ", ".join(f"{name} {factor.words(value)}" for name, factor, value in zip(names, factors, values))


def short_names(paths: Sequence[str]) -> list[str]:
    """The last part of each path; of those that share it the part before; where that is not enough, the whole path."""
    last = [path.split(".")[-1] for path in paths]
    before = [path.split(".")[-2:][0] for path in paths]
    names = [parent if last.count(end) > 1 else end for end, parent in zip(last, before)]
    return [name if names.count(name) == 1 else path for name, path in zip(names, paths)]


def _combinations(factors: Sequence[Factor]) -> int:
    return prod(len(factor.grid_values()) for factor in factors)


def _to_search(block: Any, factors: Sequence[Factor], base: Point) -> Candidates:
    trials = block.trials or USUAL_TRIALS
    if not any(factor.is_range for factor in factors) and (n := _combinations(factors)) <= trials:
        hint = "without --search all of them are compared"
        raise ValueError(f"a search of {trials} trials, and there are only {n} combinations; {hint}")
    return Candidates((), base, tuple(factors), trials)


@dataclass(frozen=True, slots=True)
class Fresh:
    """The chosen one on replications that had no part in choosing it, beside the base with the same luck.

    first, n    : replications first, ..., first + n - 1
    chosen, base : of the figure, then of each limit
    difference  : chosen minus base, of pairs; None where the base is the chosen one
    """

    first: int
    n: int
    chosen: tuple[Interval, ...]
    base: tuple[Interval, ...]
    difference: Interval | None
    p: float = float("nan")


@dataclass(frozen=True, slots=True)
class Searched:
    """What a search tried. finalists : names of the points that went on -> which trial, from 0."""

    trials: tuple[Trial, ...]
    replications: int
    finalists: Mapping[str, int]


@dataclass(frozen=True)
class Found:
    """key : the figure; keys : those of limits. indifference_said : as it was written

    changes   : of each candidate, by name; called: of those that a search found, in words
    factors   : what is varied, short name -> dotted path
    first     : number of the first replication of the choice; apart : whether each candidate has numbers of its own
    selection : None where a search left only one
    """

    key: Key
    better: str
    keys: tuple[Key, ...]
    limits: tuple[Limit, ...]
    indifference: float
    indifference_said: str
    confidence: float
    procedure: str
    base: str
    changes: Mapping[str, Mapping[str, Any]]
    first: int
    apart: bool
    selection: Selection | None
    winner: str
    most: int
    fresh: Fresh | None = None
    searched: Searched | None = None
    called: Mapping[str, str] = field(default_factory=dict)
    factors: Mapping[str, str] = field(default_factory=dict)
