"""Mean squares of a two-way table, intervals of what is made of them, and of the table's mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.study.interval import CONFIDENCE, Interval


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
