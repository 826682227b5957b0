"""Welch's curve: replications averaged, then smoothed, so that one sees where a run has settled."""

from __future__ import annotations

import numpy as np

from opsim.study.long_run.correlation import rows_of

WIDEST = 4
"""A window reaches over at most a quarter of the series to either side."""


def welch(series: np.ndarray, window: int | None = None) -> np.ndarray:
    """(n - window,) the mean of all replications, smoothed over ``window`` values to either side.

    series : (n,) or (R, n), from the very start of the run; window : by default a twentieth of the series. Near the
    start as many values to either side as there are.
    Raises ValueError where the window is wider than a quarter of the series.
    Source: Welch 1983, The statistical analysis of simulation results; Law, Simulation Modeling and Analysis, 5th ed.,
    section 9.5.1.
    """
    mean = rows_of(series).mean(axis=0)
    n = mean.size
    window = n // 20 if window is None else window
    if not 0 <= window <= n // WIDEST:
        raise ValueError(f"a window of {window} does not fit: expected 0 to {n // WIDEST}, a quarter of {n} values")
    summed = np.r_[0.0, np.cumsum(mean)]
    at = np.arange(n - window)
    reach = np.minimum(at, window)
    return (summed[at + reach + 1] - summed[at - reach]) / (2 * reach + 1)
