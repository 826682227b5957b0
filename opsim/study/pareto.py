"""Two figures of every variant against each other: which variants nothing beats, and which are beaten for sure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from opsim.kpi.catalogue import KPIS, LESS, MORE, AskedFigure
from opsim.problems import did_you_mean
from opsim.results import Key, Result
from opsim.study.compare import PER_SCHEDULED_HOUR, NotComparable, remedy, scheduled_hours, tables_of
from opsim.study.intervals import CONFIDENCE, ROUNDING, Interval, holm, paired_with_each, t_interval


@dataclass(frozen=True, slots=True)
class Point:
    """A variant: its two means with their intervals.

    on_front : no other variant is as good in both and better in one, by the means; False where a mean is not known
    behind   : the variants that are, by the means
    clearly_behind : those of them of which paired replications show it, all comparisons together
    """

    variant: str
    x: Interval
    y: Interval
    on_front: bool
    behind: tuple[str, ...]
    clearly_behind: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Frontier:
    """``x`` and ``y`` : the figures (kpi, subject, part, unit) and which way is better; ``n`` pairs of replications.

    other_hours : whether a figure is per scheduled hour and variants are open for different hours, so that what is
        better says nothing of what comes out, and nothing is clear
    absent : (variant, the figures that do not exist there), as where the effect that makes them is off; such a variant
        has no mean of them, and is beside the others
    """

    x: Key
    y: Key
    better_x: str
    better_y: str
    points: tuple[Point, ...]
    n: int
    other_hours: bool = False
    absent: tuple[tuple[str, tuple[str, ...]], ...] = ()


def non_dominated(values: np.ndarray) -> np.ndarray:
    """(V,) whether no other row is as large in both columns and larger in one. values : (V, 2), more is better.

    Rows that are equal do not beat each other; a row with a nan is not on the front and beats nobody.
    Source: Ehrgott, Multicriteria Optimization, 2nd ed. 2005, definition 2.1 (efficient solutions).
    """
    return ~dominates(values).any(axis=0) & ~np.isnan(np.asarray(values, dtype=float)).any(axis=1)


def dominates(values: np.ndarray) -> np.ndarray:
    """(V, V) whether row i is at least as large as row j in both columns, and larger in one. nan is never so."""
    rows = np.asarray(values, dtype=float).reshape(-1, 2)
    first, second = rows[:, None], rows[None]
    return np.asarray((first >= second).all(axis=-1) & (first > second).any(axis=-1))


def frontier_of(results: Mapping[str, Result], x: AskedFigure, y: AskedFigure) -> Frontier:
    """Where each variant stands; a variant in which a figure does not exist stands nowhere, and is named.

    Raises NotComparable, all mistakes at once: unknown figures, figures whose better way is not known, one figure
    twice, results of other seeds; OSError where results cannot be read.
    """
    tables = tables_of(results, (x.kpi, y.kpi))
    keys = _keys(tables, (x, y))
    _one_luck(results)
    shared = sorted(
        set.intersection(*({r for row in table.values() for r in row} for table in tables.values() if table))
    )
    values = {  # (2, n) by variant
        name: np.array([[table.get(key, {}).get(r, np.nan) for r in shared] for key in keys], dtype=float)
        for name, table in tables.items()
    }
    hours = scheduled_hours(results)
    other_hours = len(set(hours.values())) > 1 and any(key[0] in PER_SCHEDULED_HOUR for key in keys)
    signs = np.array([1.0 if asked.better == MORE else -1.0 for asked in (x, y)])
    points = placed(values, signs, tested=not other_hours)
    absent = tuple((name, lacking) for name, table in tables.items() if (lacking := _lacking(keys, table)))
    return Frontier(keys[0], keys[1], x.better, y.better, points, len(shared), other_hours, absent)


def _lacking(keys: Sequence[Key], table: Mapping[Key, object]) -> tuple[str, ...]:
    return tuple(AskedFigure(*key[:3]).name for key in keys if key not in table)


def placed(values: Mapping[str, np.ndarray], signs: np.ndarray, *, tested: bool = True) -> tuple[Point, ...]:
    """The variants in their order. values : by variant, (2, n) of both figures in n paired replications.

    signs : (2,) 1 where more is better, else -1; tested : False where nothing may be called clear
    """
    names = list(values)
    intervals = {name: [t_interval(row) for row in values[name]] for name in names}
    means = _rounded(np.array([[one.mean for one in intervals[name]] for name in names])) * signs
    ahead, front = dominates(means), non_dominated(means)
    clear = _clearly(values, signs) if tested else set()
    found = []
    for j, name in enumerate(names):
        behind = tuple(other for i, other in enumerate(names) if ahead[i, j])
        beaten = tuple(other for other in behind if (other, name) in clear)
        found.append(Point(name, intervals[name][0], intervals[name][1], bool(front[j]), behind, beaten))
    return tuple(found)


def _rounded(means: np.ndarray) -> np.ndarray:
    """(V, 2) without what adding numbers in another order leaves."""
    size = np.nanmax(np.abs(means), axis=0, initial=0.0)
    step = np.where(size > 0, size, 1.0) * ROUNDING
    return np.round(means / step) * step


def _clearly(values: Mapping[str, np.ndarray], signs: np.ndarray) -> set[tuple[str, str]]:
    """Pairs (better, worse): in each figure shown to be better or the same in every replication, in one better.

    Paired t tests of all pairs in both figures, held together at 5 % (Holm 1979).
    """
    names = sorted(values)
    stacked = np.array([values[name] for name in names], dtype=float)
    tests = [paired_with_each(one, stacked[i + 1 :]) for i, one in enumerate(stacked)]
    by, p, same = (np.concatenate(parts).reshape(-1, 2) for parts in zip(*tests))
    held = holm(np.where(same, np.nan, p).ravel().tolist()).reshape(-1, 2)
    ways = np.where(held <= 1 - CONFIDENCE, np.sign(by * signs), 0.0)
    first, second = np.triu_indices(len(names), 1)
    found = set()
    for way, better, worse in ((1.0, first, second), (-1.0, second, first)):
        clear = ((ways == way) | same.astype(bool)).all(axis=1) & (ways == way).any(axis=1)
        found |= {(names[i], names[j]) for i, j in zip(better[clear].tolist(), worse[clear].tolist())}
    return found


def _keys(tables: Mapping[str, Mapping[Key, object]], asked: Sequence[AskedFigure]) -> list[Key]:
    known: list[Key] = list(dict.fromkeys(key for table in tables.values() for key in table))
    wrong = [words for one in asked if (words := _wrong(one, known))]
    if not wrong and asked[0].name == asked[1].name:
        wrong = [f"the frontier needs two different figures, found {asked[0].name} twice"]
    if wrong:
        raise NotComparable("\n".join(wrong))
    return [next(key for key in known if key[:3] == (one.kpi, one.subject, one.part)) for one in asked]


def _wrong(asked: AskedFigure, known: Sequence[Key]) -> str:
    """What is wrong with one figure that was asked for; nothing where all is well."""
    names = dict.fromkeys(key[0] for key in known)
    if asked.kpi not in names:
        return f"no figure {asked.kpi!r}; {remedy(asked.kpi, {*names, *KPIS})}"
    of = {AskedFigure(*key[:3]).name: key for key in known if key[0] == asked.kpi}
    if asked.name not in of:
        return f"no figure {asked.name!r}; {did_you_mean(asked.name, of, otherwise='there are')}"
    if asked.better not in (MORE, LESS):
        said = f"write '{MORE} {asked.name}' or '{LESS} {asked.name}'"
        return f"{asked.name}: which way is better depends on who asks: {said}"
    return ""


def _one_luck(results: Mapping[str, Result]) -> None:
    seeds = {result.summary["seed"] for result in results.values()}
    if len(seeds) > 1:
        raise NotComparable(f"pairs need the same random numbers: found the seeds {', '.join(map(str, sorted(seeds)))}")
