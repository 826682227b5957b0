"""What a factor does to a figure: ends against a base (tornado), means over a grid. Plain functions on arrays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from opsim.study.compare import paired
from opsim.study.interval import CONFIDENCE, Interval, t_interval


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

    rise : its interval holds for the two levels that were picked (Bonferroni over all pairs of levels)
    """

    name: str
    levels: tuple[Level, ...]
    least: int
    most: int
    rise: Interval
    clear: bool

    @property
    def nothing(self) -> bool:
        """Whether the figure is the same at all levels in every replication."""
        return self.rise.n > 0 and self.rise.mean == 0 and self.rise.sd == 0

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
    found = [swing(name, {**of, names.get(name, "base"): base}, base) for name, of in ends.items()]
    return sorted(found, key=lambda one: -one.size)


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
    return sorted(found, key=lambda one: -one.size)


def swing(name: str, of: Mapping[str, Sequence[float]], reference: Sequence[float]) -> Swing:
    """One factor from the values (n,) of its levels; changes are against the reference, replication by replication."""
    rows = {level: np.asarray(values, dtype=float) for level, values in of.items()}
    levels = tuple(Level(level, t_interval(row), paired(row.tolist(), reference)[0]) for level, row in rows.items())
    means = np.array([level.mean.mean for level in levels])
    if np.isnan(means).all():
        return Swing(name, levels, 0, 0, Interval(np.nan, np.nan, np.nan, 0), False)
    least, most = int(np.nanargmin(means)), int(np.nanargmax(means))
    each = list(rows.values())
    rise, p, _ = paired(each[most].tolist(), each[least].tolist())
    pairs = max(1, len(levels) * (len(levels) - 1) // 2)
    if rise.n > 1:
        p *= pairs
        rise = _wider(rise, pairs)
    return Swing(name, levels, least, most, rise, bool(p <= 1 - CONFIDENCE))


def _wider(interval: Interval, comparisons: int) -> Interval:
    """The interval that holds together with those of so many comparisons (Bonferroni)."""
    from scipy.special import stdtrit

    t = float(stdtrit(interval.n - 1, 1 - (1 - CONFIDENCE) / (2 * comparisons)))
    return Interval(interval.mean, t * interval.sd / float(np.sqrt(interval.n)), interval.sd, interval.n)
