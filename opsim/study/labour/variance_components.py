"""Mean squares of a two-way table, intervals of what is made of them, and of the table's mean.

What moves a figure: who is hired, the luck of the day, and both together. A two-way table with random effects.

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

from opsim.study.intervals import CONFIDENCE, Interval


@dataclass(frozen=True, slots=True)
class MeanSquare:
    """A mean square and its degrees of freedom; a fraction where they stand for tails that are longer than normal."""

    value: float
    df: float


@dataclass(frozen=True, slots=True)
class Squares:
    """Mean squares of a (W, R) table: between rows, between columns (None where nested), and what is left."""

    shape: tuple[int, int]
    rows: MeanSquare
    columns: MeanSquare | None
    rest: MeanSquare


def squares_of(table: np.ndarray, crossed: bool) -> Squares:
    """table : (W, R), W and R at least 2, nothing missing."""
    n_rows, n_columns = table.shape
    of_rows, of_columns, whole = table.mean(axis=1), table.mean(axis=0), table.mean()
    rows = MeanSquare(n_columns * float(np.sum((of_rows - whole) ** 2)) / (n_rows - 1), _df_of(of_rows))
    if not crossed:
        left = table - of_rows[:, None]
        df = n_rows * (n_columns - 1)
        return Squares((n_rows, n_columns), rows, None, MeanSquare(float(np.sum(left**2)) / df, df))
    columns = MeanSquare(n_rows * float(np.sum((of_columns - whole) ** 2)) / (n_columns - 1), n_columns - 1)
    left = table - of_rows[:, None] - of_columns + whole
    df = (n_rows - 1) * (n_columns - 1)
    return Squares((n_rows, n_columns), rows, columns, MeanSquare(float(np.sum(left**2)) / df, df))


def _df_of(values: np.ndarray) -> float:
    """n - 1, or fewer where the tails are longer than normal: a few odd workforces then decide their variance.

    Source: Shoemaker 2003, Fixing the F test for equal variances, The American Statistician 57:105-114, with
    b2 the sample's fourth moment over its squared second.
    """
    n, apart = values.size, values - values.mean()
    second, fourth = float(np.mean(apart**2)), float(np.mean(apart**4))
    if second <= 0 or fourth <= 3 * second**2:
        return n - 1
    return 2 * n / (fourth / second**2 - (n - 3) / (n - 1))


def sum_interval(terms: Sequence[tuple[float, MeanSquare]], confidence: float = CONFIDENCE) -> tuple[float, float]:
    """(low, high) of a sum of c x expected mean square, c >= 0; exact for a single one.

    Source: Graybill & Wang 1980; Burdick & Graybill 1992, section 3.2.
    """
    miss = (1 - confidence) / 2
    middle = sum(c * one.value for c, one in terms)
    down = sum((_g(one.df, miss) * c * one.value) ** 2 for c, one in terms)
    up = sum((_h(one.df, miss) * c * one.value) ** 2 for c, one in terms)
    return middle - float(np.sqrt(down)), middle + float(np.sqrt(up))


def difference_interval(upper: MeanSquare, lower: MeanSquare, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """(low, high) of the difference of two expected mean squares.

    Source: Ting, Burdick, Graybill, Jeyaratnam & Lu 1990; Burdick & Graybill 1992, section 3.3.
    """
    miss = (1 - confidence) / 2
    a, b = upper.value, lower.value
    g1, g2, h1, h2 = _g(upper.df, miss), _g(lower.df, miss), _h(upper.df, miss), _h(lower.df, miss)
    high_f, low_f = _f(upper.df, lower.df, miss), _f(upper.df, lower.df, 1 - miss)
    g12 = ((high_f - 1) ** 2 - (g1 * high_f) ** 2 - h2**2) / high_f
    h12 = ((1 - low_f) ** 2 - (h1 * low_f) ** 2 - g2**2) / low_f
    down = (g1 * a) ** 2 + (h2 * b) ** 2 + g12 * a * b
    up = (h1 * a) ** 2 + (g2 * b) ** 2 + h12 * a * b
    return a - b - float(np.sqrt(max(0.0, down))), a - b + float(np.sqrt(max(0.0, up)))


def mean_interval(table: np.ndarray, crossed: bool, confidence: float = CONFIDENCE) -> Interval:
    """Interval of the mean of a (W, R) table over other workforces and other days.

    Values of one workforce, and crossed also those of one day, go together: its variance is (MS_W + MS_R - MS_rest) /
    (W R), nested MS_W / (W R), with Satterthwaite's degrees of freedom; never less than one of the two alone.
    Crossed with two columns the 95 % interval covers 0.88 to 0.91, since two days cannot tell how much days differ;
    with three 0.93 to 0.95.
    Source: Satterthwaite 1946, Biometrics Bulletin 2:110-114.
    """
    from scipy.special import stdtrit  # scipy.stats costs three times this import

    found = squares_of(table, crossed)
    terms = [found.rows] if found.columns is None else [found.rows, found.columns]
    variance, df = _of_mean(terms, found.rest)
    error = np.sqrt(variance / table.size)
    half = float(stdtrit(df, (1 + confidence) / 2) * error) if error > 0 else 0.0
    return Interval(float(table.mean()), half, float(table.std(ddof=1)), table.size)


def _of_mean(terms: Sequence[MeanSquare], rest: MeanSquare) -> tuple[float, float]:
    """(variance of the mean times the number of values, its degrees of freedom)"""
    most = max(terms, key=lambda one: one.value)
    if len(terms) == 1 or min(one.value for one in terms) <= rest.value:
        return most.value, most.df
    variance = sum(one.value for one in terms) - rest.value
    return variance, variance**2 / sum(one.value**2 / one.df for one in (*terms, rest))


def _f(df1: float, df2: float, above: float) -> float:
    """The value that F exceeds with a chance of ``above``."""
    from scipy.special import fdtri

    return float(fdtri(df1, df2, 1 - above))


def _chi2_each(df: float, above: float) -> float:
    from scipy.special import chdtri

    return float(chdtri(df, above)) / df


def _g(df: float, miss: float) -> float:
    return 1 - 1 / _chi2_each(df, miss)


def _h(df: float, miss: float) -> float:
    return 1 / _chi2_each(df, 1 - miss) - 1


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
