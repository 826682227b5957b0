"""How alike neighbours in a series are: correlogram, lag-1 correlation without its bias, von Neumann's test."""

from __future__ import annotations

import numpy as np


def rows_of(series: np.ndarray) -> np.ndarray:
    """A series (n,) or one a replication (R, n) as (R, n) floats. Raises ValueError where a value is not finite."""
    rows = np.atleast_2d(np.asarray(series, dtype=float))
    if rows.ndim != 2:
        raise ValueError(f"a series has one axis, or two with replications first; found {rows.ndim}")
    if not np.all(np.isfinite(rows)):
        raise ValueError("a value of the series is not finite")
    return rows


def correlogram(series: np.ndarray, most: int) -> np.ndarray:
    """(lags,) autocorrelation at lags 0, 1, .. ``most``, replications pooled about their common mean; 0 of a constant.

    series : (n,) or (R, n); lags beyond n - 1 are left out
    Source: Box & Jenkins, Time Series Analysis, eq. 2.1.13 (divisor n at every lag).
    """
    apart = rows_of(series)
    apart = apart - apart.mean()
    squares = float(np.sum(apart**2))
    n = apart.shape[1]
    sums = [float(np.sum(apart[:, : n - lag] * apart[:, lag:])) for lag in range(min(most, n - 1) + 1)]
    if squares <= _rounding(series):
        return np.r_[1.0, np.zeros(len(sums) - 1)]
    return np.array(sums) / squares


def lag_one(series: np.ndarray) -> float:
    """Lag-1 correlation of (n,) or (R, n) by the jackknife of both halves, which takes most of its bias away.

    Source: Law & Carson 1979, A sequential procedure for determining the length of a steady-state simulation,
    Operations Research 27:1011-1025, eq. 5 (after Quenouille 1956).
    """
    rows = rows_of(series)
    half = rows.shape[1] // 2
    if half < 2:
        return float(correlogram(rows, 1)[-1]) if rows.shape[1] > 1 else 0.0
    whole, first, second = (float(correlogram(part, 1)[1]) for part in (rows, rows[:, :half], rows[:, half:]))
    return 2 * whole - (first + second) / 2


def von_neumann(values: np.ndarray) -> tuple[float, float]:
    """(ratio, p) of (n,) values: the ratio is 2 where neighbours are independent, less where they are alike.

    p : one-sided, of being so alike by luck, from the normal distribution; nan below 4 values, 1 of a constant
    Source: von Neumann 1941, Ann. Math. Stat. 12:367-395; as a test of batch means: Fishman 1978, Grouping
    observations in digital simulation, Management Science 24:510-521.
    """
    from scipy.special import ndtr

    one = np.asarray(values, dtype=float)
    n, squares = one.size, float(np.sum((one - one.mean()) ** 2))
    if n < 4:
        return np.nan, np.nan
    if squares <= _rounding(one):
        return 2.0, 1.0
    ratio = float(np.sum(np.diff(one) ** 2)) / squares
    return ratio, float(ndtr(-(1 - ratio / 2) / np.sqrt((n - 2) / (n**2 - 1))))


def _rounding(values: np.ndarray) -> float:
    """Sums of squares below this are what adding numbers in another order leaves."""
    of = np.asarray(values, dtype=float)
    return of.size * (1e-12 * float(np.max(np.abs(of), initial=0.0))) ** 2
