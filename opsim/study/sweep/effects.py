"""The error of a fit itself, beside the luck of its replications: where levels are read from a fit, not run.

What a factor does to a figure: ends against a base (tornado), means over a grid. Plain functions on arrays.

What each factor does by a fitted response, with the fit's own error.

The best of the points, and which others are not told from it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from opsim.kpi.catalogue import LESS, MORE
from opsim.results import Key
from opsim.study.intervals import CONFIDENCE, Interval, holm, paired, t_interval
from opsim.study.sweep.designs import Sensitivity
from opsim.study.sweep.factors import Factor
from opsim.study.sweep.response_surface import Response, columns


@dataclass(frozen=True, slots=True)
class BesideFit:
    """Standard errors that the misfit gives levels of a factor, with ``degrees`` of freedom.

    rows : by level, (C,) what multiplies the coefficients there; reference : the same where changes are against
    """

    response: Response
    rows: Mapping[str, np.ndarray]
    reference: np.ndarray

    @property
    def degrees(self) -> int:
        """Points beyond the terms, from which the misfit is known."""
        return self.response.spare

    def of(self, level: str) -> float:
        """Of the mean at a level."""
        return self.response.misfit_of(self.rows[level], 1)

    def against_reference(self, level: str) -> float:
        """Of a level's change; nothing where it is the reference."""
        return self._of_difference(self.rows[level] - self.reference)

    def between(self, one: str, other: str) -> float:
        """Of the difference of two levels."""
        return self._of_difference(self.rows[one] - self.rows[other])

    def _of_difference(self, row: np.ndarray) -> float:
        return self.response.misfit_of(row, 2) if row.any() else 0.0


@dataclass(frozen=True, slots=True)
class Level:
    """One level of a factor: the figure's mean there, and its change against the reference, both with intervals."""

    name: str
    mean: Interval
    change: Interval


@dataclass(frozen=True, slots=True)
class Swing:
    """One factor: its levels, and from which of them (``least``) to which (``most``) the figure rises most, and by how
    much; ``clear`` where that is told from chance.

    rise, p : its interval and p hold for the two levels that were picked (Bonferroni over all pairs of levels)
    clear   : among the factors of ``ranked``, held over all of them together (Holm)
    """

    name: str
    levels: tuple[Level, ...]
    least: int
    most: int
    rise: Interval
    p: float
    clear: bool

    @property
    def nothing(self) -> bool:
        """Whether the figure is the same at all levels in every replication."""
        return self.rise.n > 0 and self.rise.mean == 0 == self.rise.sd and not self.rise.half_width > 0

    @property
    def size(self) -> float:
        """By which factors are sorted."""
        return abs(self.rise.mean) if np.isfinite(self.rise.mean) else -1.0


def tornado(
    base: Sequence[float],
    ends: Mapping[str, Mapping[str, Sequence[float]]],
    base_names: Mapping[str, str] | None = None,
) -> list[Swing]:
    """Each factor's ends against the base, the largest swing first.

    base : (n,) values of n replications; ends : by factor and by the name of its end, (n,) values with the same luck
    base_names : by factor, what the base is called; an end of that name is the base itself
    The base counts as a level of each factor, as the figure may be best, or worst, in the middle.
    """
    names = base_names or {}
    return ranked([swing(name, {**of, names.get(name, "base"): base}, base) for name, of in ends.items()])


def main_effects(
    design: np.ndarray, values: np.ndarray, names: Sequence[str], levels: Sequence[Sequence[str]]
) -> list[Swing]:
    """Each factor's level means over all points of a balanced design against the mean of all, the largest swing first.

    design : (P, F) level numbers; values : (P, n) of n replications; levels : the names of each factor's levels
    """
    whole = values.mean(axis=0)
    found = []
    for factor, (name, words) in enumerate(zip(names, levels)):
        of = {word: values[design[:, factor] == k].mean(axis=0) for k, word in enumerate(words)}
        found.append(swing(name, of, whole))
    return ranked(found)


def ranked(swings: Sequence[Swing], any_clear: bool = True) -> list[Swing]:
    """The largest swing first, ``clear`` where it is so among all of them (Holm). any_clear : False leaves none clear

    A factor that has one level only was not varied, and is left out.
    """
    varied = [one for one in swings if len(one.levels) > 1]
    together = holm([np.nan if one.nothing else one.p for one in varied])
    told = [replace(one, clear=any_clear and bool(p <= 1 - CONFIDENCE)) for one, p in zip(varied, together)]
    return sorted(told, key=lambda one: -one.size)


def swing(
    name: str, of: Mapping[str, Sequence[float]], reference: Sequence[float], fit: BesideFit | None = None
) -> Swing:
    """One factor from the values (n,) of its levels; changes are against the reference, replication by replication.

    fit : the error of the fit that the values are read from, which comes beside the luck of the replications
    """
    rows = {level: np.asarray(values, dtype=float) for level, values in of.items()}
    levels = tuple(_level(level, row, reference, fit) for level, row in rows.items())
    means = np.array([level.mean.mean for level in levels])
    if np.isnan(means).all():
        return Swing(name, levels, 0, 0, Interval(np.nan, np.nan, np.nan, 0), np.nan, False)
    least, most = int(np.nanargmin(means)), int(np.nanargmax(means))
    each, pairs = list(rows.values()), max(1, len(levels) * (len(levels) - 1) // 2)
    rise, p, _ = paired(each[most].tolist(), each[least].tolist())
    error = 0.0 if fit is None else fit.between(levels[most].name, levels[least].name)
    rise, p = _held(rise, p, pairs, error, 0 if fit is None else fit.degrees)
    return Swing(name, levels, least, most, rise, p, bool(p <= 1 - CONFIDENCE))


def _level(name: str, row: np.ndarray, reference: Sequence[float], fit: BesideFit | None) -> Level:
    mean, change = t_interval(row), paired(row.tolist(), reference)[0]
    if fit is not None:
        mean = _held(mean, np.nan, 1, fit.of(name), fit.degrees)[0]
        change = _held(change, np.nan, 1, fit.against_reference(name), fit.degrees)[0]
    return Level(name, mean, change)


def _held(interval: Interval, p: float, comparisons: int, error: float, spare: int) -> tuple[Interval, float]:
    """The interval and p that hold together with those of so many comparisons (Bonferroni).

    error, spare : a fit's standard error and its degrees of freedom, added to the luck of the replications with the
    degrees of Welch & Satterthwaite
    """
    from scipy.special import stdtr, stdtrit

    if interval.n < 2:
        return interval, p
    luck, degrees = interval.sd / float(np.sqrt(interval.n)), float(interval.n - 1)
    both = float(np.hypot(luck, error))
    if error > 0:
        degrees = both**4 / (luck**4 / degrees + error**4 / spare)
        p = 2 * float(stdtr(degrees, -abs(interval.mean) / both))
    t = float(stdtrit(degrees, 1 - (1 - CONFIDENCE) / (2 * comparisons)))
    return replace(interval, half_width=t * both), float(np.minimum(1.0, p * comparisons))


def effects_by_fit(factors: Sequence[Factor], response: Response) -> list[Swing]:
    """Each factor at its ends and in its middle, the others in theirs; of categories, each against the mean of all.

    Intervals hold the luck of the replications and the misfit; nothing is clear by a fit that is not to be trusted.
    """
    each = response.per_replication if response.per_replication.size else response.coefficients[:, None]
    centre = columns(response.terms, _plain_centre(response), response.room)[0]
    found = []
    for column, factor in enumerate(factors):
        rows = {words: _row(response, column, number) for number, words in _levels(factor)}
        of = {words: row @ each for words, row in rows.items()}
        found.append(swing(factor.path, of, centre @ each, BesideFit(response, rows, centre)))
    return ranked(found, any_clear=response.trusted)


def _levels(factor: Factor) -> list[tuple[float, str]]:
    """(number, words) of the values, of a range with its middle."""
    values = list(factor.values)
    if not factor.categories and factor.is_range:
        values.insert(1, factor.at(0.5))
    return [(factor.number(value), factor.words(value)) for value in values]


def _plain_centre(response: Response) -> np.ndarray:
    """The middle of every factor; -1, which is no category, where it has no order: their mean."""
    categories = np.array(response.room.categories) > 0
    return np.where(categories, np.nan, 0.0)[None]


def _row(response: Response, column: int, number: float) -> np.ndarray:
    scaled = _plain_centre(response)
    room = response.room
    scaled[0, column] = number if room.categories[column] else (number - room.centre[column]) / room.half[column]
    return columns(response.terms, scaled, room)[0]


@dataclass(frozen=True, slots=True)
class Best:
    """The point that is best in the replications that both of a pair have; ``like_it`` other points are not told from
    it (paired, all together, Holm). shared : the fewest replications that it has together with another point
    """

    row: int
    mean: Interval
    like_it: int
    better: str
    shared: int


@dataclass(frozen=True)
class Found:
    """One figure. means : a point each; how : what the changes of ``swings`` are against; noise_share : of the variance
    of the points' means, how much is luck (nan where it is not known)

    better : MORE or LESS, or "" where nobody said and nobody agrees; values : (P, n) of the replications
    """

    key: Key
    means: tuple[Interval, ...]
    how: str = ""
    swings: tuple[Swing, ...] = ()
    response: Response | None = None
    no_response: str = ""
    sensitivity: tuple[Sensitivity, ...] = ()
    best: Best | None = None
    noise_share: float = float("nan")
    replications: int = 1
    factors: tuple[Factor, ...] = field(default=(), repr=False)
    better: str = ""
    values: np.ndarray = field(default_factory=lambda: np.zeros((0, 0)), repr=False, compare=False)


def best_of(values: np.ndarray, means: Sequence[Interval], better: str) -> Best:
    """The best point, and how many others are not told from it. values : (P, n), nan where a figure has no value"""
    row = _champion(values * {MORE: 1.0, LESS: -1.0}[better], means)
    tests = [paired(values[row], other) for place, other in enumerate(values) if place != row]
    p = holm([np.nan if i.n > 0 and i.mean == 0 and i.sd == 0 else p for i, p, _ in tests])
    ahead = np.array([i.mean for i, _, _ in tests]) * {MORE: 1.0, LESS: -1.0}[better] > 0
    clear = int(np.count_nonzero((p <= 1 - CONFIDENCE) & ahead))
    return Best(row, means[row], len(tests) - clear, better, min((i.n for i, _, _ in tests if i.n), default=0))


def _champion(values: np.ndarray, means: Sequence[Interval]) -> int:
    """The row that is highest; where values are missing, the last that beat the one before it in what both have.

    Means over different replications would compare their luck. values : (P, n), more is better
    """
    with np.errstate(invalid="ignore"):
        whole = np.array([np.nan if not one.n else np.nanmean(row) for row, one in zip(values, means)])
    row = int(np.nanargmax(whole))
    if np.isnan(values).any():
        for other in range(len(values)):
            by = values[other] - values[row]
            if not np.isnan(by).all() and np.nanmean(by) > 0:
                row = other
    return row
