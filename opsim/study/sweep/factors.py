"""A factor of a sweep: a dotted path with the values that it takes, as they are written in a file.

The points of a sweep: which values each factor has at each of them, by any design.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from opsim.scenario.schema.sweep import COUNTED, SENSITIVITY, Range, Sweep, between, is_whole, number_of, steps
from opsim.scenario.variants import flow_text
from opsim.streams import stream
from opsim.study.jobs import Point
from opsim.study.sweep import designs
from opsim.units import UNITS

AS_IT_IS = "as it is"
"""What a factor's level is called where a point leaves it as the scenario has it."""


class Unchanged:
    """The value of a factor that a point leaves as the scenario has it."""

    def __repr__(self) -> str:
        return AS_IT_IS


UNCHANGED = Unchanged()


@dataclass(frozen=True)
class Factor:
    """``values`` : those that it may take, or both ends of a range; ``levels`` of a range in a grid, else None."""

    path: str
    values: tuple[Any, ...]
    is_range: bool = False
    levels: int | None = None

    @property
    def name(self) -> str:
        """The last two parts of its path, which say enough in a picture: ``saw.buffer``."""
        return ".".join(self.path.split(".")[-2:])

    @property
    def ends(self) -> tuple[Any, ...]:
        """The values that are tried one at a time, and checked before the first run."""
        return self.values

    def at(self, share: float) -> Any:
        """The value at a share from 0 to 1 of its range, or of its list, each with the same part of the way."""
        if self.is_range:
            return between(self.values[0], self.values[1], share)
        return self.values[min(len(self.values) - 1, int(share * len(self.values)))]

    def at_even(self, share: float) -> Any:
        """As ``at`` for shares on an even grid with both ends (Morris): whole numbers and lists by the nearest step.

        Equal steps of such shares are then equal steps here, while parts of the way would put two of them together.
        """
        steps = self.steps
        if not steps:
            return self.at(share)
        step = round(share * steps)
        return self.values[0] + step if self.is_range else self.values[step]

    @property
    def steps(self) -> int:
        """From the first of its values to the last; 0 where there are values in between, or only one."""
        if self.is_range:
            return int(self.values[1] - self.values[0]) if is_whole(*self.values) else 0
        return len(self.values) - 1

    def grid_values(self) -> list[Any]:
        """The values that it takes in a grid."""
        if self.is_range:
            return steps(self.values[0], self.values[1], self.levels or 2)
        return list(self.values)

    @cached_property
    def unit(self) -> str:
        """Of its numbers: that of the first value."""
        known = [found for value in self.values if value is not UNCHANGED and (found := number_of(value))]
        return known[0][1] if known else ""

    @cached_property
    def is_number(self) -> bool:
        """Whether its values have an order: all of them are numbers, or quantities of one kind."""
        said = [value for value in self.values if value is not UNCHANGED]
        return bool(said) and len(said) == len(self.values) and all(self._number(value) is not None for value in said)

    def number(self, value: Any) -> float:
        """A value in ``unit``; of values without an order, and of lists between two, which one or how far it is."""
        if self.is_number:
            found = self._number(value)
            assert found is not None
            return found
        if self.is_range:
            return _share_of_lists(value, *self.values)
        return float([flow_text(one) for one in self.values].index(flow_text(value)))

    @property
    def categories(self) -> int:
        """How many values it has where they have no order, else 0."""
        return 0 if self.is_number or self.is_range else len(self.values)

    @property
    def span(self) -> tuple[float, float]:
        """The least and the largest of its numbers."""
        numbers = [self.number(value) for value in self.values]
        return min(numbers), max(numbers)

    def words(self, value: Any) -> str:
        """A value as it is written."""
        return AS_IT_IS if value is UNCHANGED else flow_text(value)

    def _number(self, value: Any) -> float | None:
        """In the factor's unit; None where it is no number of the same kind."""
        found = number_of(value)
        if found is None or found[1] == self.unit:
            return None if found is None else found[0]
        sizes = next((units for units in UNITS.values() if self.unit in units), {})
        if found[1] not in sizes:
            return None
        return float(found[0] * float(sizes[found[1]] / sizes[self.unit]))


def factors_of(vary: Mapping[str, Range | Sequence[Any]], levels: int | None = None) -> tuple[Factor, ...]:
    """The factors of a block ``vary``; values given twice count once. levels : of ranges that say none themselves"""
    return tuple(
        Factor(path, (of.low, of.high), True, of.levels or levels) if isinstance(of, Range) else _listed(path, of)
        for path, of in vary.items()
    )


def factors_of_points(points: Sequence[Mapping[str, Any]]) -> tuple[Factor, ...]:
    """The factors of points given one by one, with all values that they take there."""
    paths = dict.fromkeys(path for point in points for path in point)
    return tuple(_listed(path, [point.get(path, UNCHANGED) for point in points]) for path in paths)


def _listed(path: str, values: Sequence[Any]) -> Factor:
    unique = {repr(UNCHANGED) if value is UNCHANGED else "=" + flow_text(value): value for value in values}
    return Factor(path, tuple(unique.values()))


def _share_of_lists(value: Any, low: Any, high: Any) -> float:
    """How far a list is from one to another: by the first of their numbers that differs."""
    for one, first, last in zip(value, low, high):
        if first != last:
            if isinstance(first, list):
                return _share_of_lists(one, first, last)
            a, b, c = (found[0] for end in (one, first, last) if (found := number_of(end)))
            return (a - b) / (c - b)
    return 0.0


PER_FACTOR = 10
"""Points of a design that spreads them, where nobody says how many. Source: Loeppky, Sacks & Welch 2009,
Technometrics 51:366-376 (ten times the number of factors)."""
USUAL_COUNT = {"sobol_indices": 64, "morris": 10}
MOST_POINTS = 100_000


@dataclass(frozen=True)
class Points:
    """What a sweep looks at.

    design  : its name; array : (P, F) shares or level numbers as ``opsim.study.sweep.designs`` gives them
    values  : (P, F) plain values; UNCHANGED where a point leaves a factor as the scenario has it
    words   : what is to be said of the design; warned : the same, beside the answer
    bases  : by path, what the scenario has there, in words
    """

    design: str
    factors: tuple[Factor, ...]
    array: np.ndarray
    values: tuple[tuple[Any, ...], ...]
    words: tuple[str, ...] = ()
    warned: tuple[str, ...] = ()
    bases: Mapping[str, str] = field(default_factory=dict)

    def points(self, variant: str | None) -> list[Point]:
        """To be run, in order; two rows with the same values are the same point, one at a time the base among them."""
        width = len(str(len(self.values)))
        return [
            Point(f"point {row + 1:0{width}d}", self._changes(values), variant)
            for row, values in enumerate(self.values)
        ]

    def numbers(self) -> np.ndarray:
        """(P, F) each factor's number, in its unit; nan where a point leaves it as it is."""
        return np.array(
            [[_number(f, value) for f, value in zip(self.factors, values)] for values in self.values], dtype=float
        ).reshape(len(self.values), len(self.factors))

    def _changes(self, values: Sequence[Any]) -> dict[str, Any]:
        said = [(factor, value) for factor, value in zip(self.factors, values) if value is not UNCHANGED]
        if self.design == "one_at_a_time" and all(f.words(value) == self.bases.get(f.path) for f, value in said):
            return {}
        return {factor.path: value for factor, value in said}


def points_of(asked: Sweep, seed: int) -> Points:
    """The points that a block ``sweep`` asks for. seed : of the scenario; the same seed gives the same points.

    Raises ValueError where there are too many, Missing where a design needs SALib and it is not installed.
    """
    design = asked.chosen
    if isinstance(asked.points, list):
        factors = factors_of_points(asked.points)
        values = tuple(tuple(point.get(f.path, UNCHANGED) for f in factors) for point in asked.points)
        return Points(design, factors, _level_numbers(factors, values), values)
    factors = factors_of(asked.vary or {}, asked.levels)
    if design in COUNTED:
        return _counted(design, factors, asked.points, seed)
    levels = [f.grid_values() if design == "grid" else list(f.ends) for f in factors]
    counts = [len(of) for of in levels]
    _refuse_too_many(float(np.prod(counts, dtype=float)) if design == "grid" else sum(counts))
    array = designs.grid(counts) if design == "grid" else designs.one_at_a_time(counts)
    values = tuple(tuple(UNCHANGED if k < 0 else of[k] for of, k in zip(levels, row)) for row in array.tolist())
    unused = f"The points of the design {design} follow from its factors: 'points: {asked.points}' is not used."
    return Points(design, factors, array, values, warned=() if asked.points is None else (unused,))


def _counted(design: str, factors: tuple[Factor, ...], n: int | None, seed: int) -> Points:
    if n is None:
        n = USUAL_COUNT.get(design) or PER_FACTOR * len(factors)
        n = designs.power_of_two(n) if design == "sobol" else n
    _refuse_too_many(n * (len(factors) + 2 if design in SENSITIVITY else 1))
    rng = stream(seed, 0, "sweep", design)
    make = {
        "latin_hypercube": designs.latin_hypercube,
        "sobol": designs.sobol,
        "sobol_indices": designs.saltelli,
        "morris": designs.morris,
    }[design]
    array = make(n, len(factors), rng)
    values = tuple(
        tuple(f.at_even(s) if design == "morris" else f.at(s) for f, s in zip(factors, row)) for row in array.tolist()
    )
    return Points(design, factors, array, values, tuple(_of_powers(design, n)))


def _of_powers(design: str, n: int) -> list[str]:
    full = designs.power_of_two(n)
    if design not in ("sobol", "sobol_indices") or full == n:
        return []
    return [f"A Sobol sequence is evenest at powers of two: {n} is none, {full // 2} and {full} are."]


def _refuse_too_many(n: float) -> None:
    if n > MOST_POINTS:
        hint = "take fewer levels, or the design latin_hypercube"
        raise ValueError(f"this sweep has {n:,.0f} points, at most {MOST_POINTS:,} are run; {hint}")


def _level_numbers(factors: Sequence[Factor], values: Sequence[Sequence[Any]]) -> np.ndarray:
    words = [[f.words(value) for value in f.values] for f in factors]
    rows = [[of.index(f.words(value)) for f, of, value in zip(factors, words, row)] for row in values]
    return np.array(rows, dtype=int)


def _number(factor: Factor, value: Any) -> float:
    if value is not UNCHANGED:
        return factor.number(value)
    return float("nan") if UNCHANGED not in factor.values else float(factor.values.index(UNCHANGED))
