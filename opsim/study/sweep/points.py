"""The points of a sweep: which values each factor has at each of them, by any design."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from opsim.scenario.schema.studies.sweep import COUNTED, SENSITIVITY, Sweep
from opsim.streams import stream
from opsim.study.jobs import Point
from opsim.study.sweep import designs
from opsim.study.sweep.factors import UNCHANGED, Factor, factors_of, factors_of_points

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
        """To be run, in order; two rows with the same values are the same point."""
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
        pairs = zip(self.factors, values)
        return {factor.path: value for factor, value in pairs if value is not UNCHANGED}


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
