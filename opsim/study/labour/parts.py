"""What moves a figure: who is hired, the luck of the day, and both together. A two-way table with random effects.

``values`` is (W, R): W workforces, R replications of each. Crossed: column j is the same luck for all workforces;
y_ij = m + w_i + r_j + i_ij. Nested: each row has luck of its own; y_ij = m + w_i + r_ij.
A workforce on a day gives one value, whatever is done again: so the interaction is the part of luck that hits one
workforce otherwise than the others, and nothing is left beside it.
Source: Burdick & Graybill 1992, Confidence Intervals on Variance Components, sections 3.2 and 3.3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.study.interval import CONFIDENCE
from opsim.study.labour.squares import MeanSquare, Squares, difference_interval, squares_of, sum_interval

CROSSED, NESTED = "crossed", "nested"
STAFFING, DAY, INTERACTION, RUN = "staffing", "day", "interaction", "run"


@dataclass(frozen=True, slots=True)
class VariancePart:
    """A part of the variance of a figure, in the figure's unit squared.

    low, high : of the variance, at least 0; truncated : the estimate was ``estimate`` < 0 and is told as 0, since no
                variance is less; there is then no sign of this part
    """

    name: str
    estimate: float
    low: float
    high: float

    @property
    def variance(self) -> float:
        return max(0.0, self.estimate)

    @property
    def truncated(self) -> bool:
        return self.estimate < 0

    @property
    def sd(self) -> float:
        return float(np.sqrt(self.variance))

    @property
    def low_sd(self) -> float:
        return float(np.sqrt(self.low))

    @property
    def high_sd(self) -> float:
        return float(np.sqrt(self.high))


@dataclass(frozen=True, slots=True)
class VarianceParts:
    """The parts of one figure's variance over all workforces and days.

    parts : staffing luck; crossed: luck of the day that all workforces share, and interaction; nested: run noise
    run   : run noise, what is left for one given workforce: day and interaction together where they are told apart
    """

    design: str
    shape: tuple[int, int]
    mean: float
    parts: tuple[VariancePart, ...]
    run: VariancePart

    def __getitem__(self, name: str) -> VariancePart:
        return self.run if name == RUN else next(part for part in self.parts if part.name == name)

    @property
    def total(self) -> float:
        """Variance of one workforce on one day, drawn anew."""
        return sum(part.variance for part in self.parts)

    def share(self, name: str) -> float:
        """Of a part, in the total; nan where nothing varies."""
        return self[name].variance / self.total if self.total > 0 else np.nan


def variance_parts(
    values: Sequence[Sequence[float]] | np.ndarray, design: str = CROSSED, confidence: float = CONFIDENCE
) -> VarianceParts:
    """Split the variance of a (W, R) table of one figure: W workforces, R replications of each.

    Estimates by mean squares; the interval of the interaction (nested: of run noise) is exact for normal values, the
    others are modified large sample intervals (Burdick & Graybill 1992, sections 3.2 and 3.3).
    Raises ValueError where W < 2, R < 2, a value is missing, or the design is unknown.
    """
    table = np.asarray(values, dtype=float)
    _check(table, design)
    found = squares_of(table, design == CROSSED)
    parts, run = (_crossed if design == CROSSED else _nested)(found, confidence)
    return VarianceParts(design, (table.shape[0], table.shape[1]), float(table.mean()), parts, run)


def _crossed(found: Squares, confidence: float) -> tuple[tuple[VariancePart, ...], VariancePart]:
    assert found.columns is not None
    n_rows, n_columns = found.shape
    rest, columns = found.rest, found.columns
    parts = (
        _difference(STAFFING, found.rows, rest, n_columns, confidence),
        _difference(DAY, columns, rest, n_rows, confidence),
        _sum(INTERACTION, [(1.0, rest)], confidence),
    )
    return parts, _sum(RUN, [(1.0 / n_rows, columns), (1.0 - 1.0 / n_rows, rest)], confidence)


def _nested(found: Squares, confidence: float) -> tuple[tuple[VariancePart, ...], VariancePart]:
    run = _sum(RUN, [(1.0, found.rest)], confidence)
    return (_difference(STAFFING, found.rows, found.rest, found.shape[1], confidence), run), run


def _difference(name: str, upper: MeanSquare, lower: MeanSquare, each: int, confidence: float) -> VariancePart:
    low, high = difference_interval(upper, lower, confidence)
    return VariancePart(name, (upper.value - lower.value) / each, max(0.0, low / each), max(0.0, high / each))


def _sum(name: str, terms: list[tuple[float, MeanSquare]], confidence: float) -> VariancePart:
    low, high = sum_interval(terms, confidence)
    return VariancePart(name, sum(factor * one.value for factor, one in terms), max(0.0, low), high)


def _check(table: np.ndarray, design: str) -> None:
    if design not in (CROSSED, NESTED):
        raise ValueError(f"no design {design!r}; known: {CROSSED}, {NESTED}")
    if table.ndim != 2:
        raise ValueError(f"expected a table of workforces x replications, found {table.ndim} dimensions")
    if table.shape[0] < 2:
        raise ValueError(f"one workforce cannot tell how much they differ, found {table.shape[0]}; take 2 or more")
    if table.shape[1] < 2:
        raise ValueError(
            f"with {table.shape[1]} replication of each workforce, who the people are and the luck of the day cannot "
            "be told apart; take 2 or more"
        )
    if not np.isfinite(table).all():
        raise ValueError(f"{np.count_nonzero(~np.isfinite(table))} of {table.size} values are missing")
