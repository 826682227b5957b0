"""Means of pieces of a series, one after another or overlapping."""

from __future__ import annotations

import numpy as np

from opsim.study.interval import CONFIDENCE
from opsim.study.long_run.correlation import rows_of


def pieces(series: np.ndarray, n: int) -> np.ndarray:
    """(R, n) means of ``n`` pieces of equal length of each row; what fills none is left out at the front."""
    rows = rows_of(series)
    size = rows.shape[1] // n
    return rows[:, rows.shape[1] - n * size :].reshape(rows.shape[0], n, size).mean(axis=2)


def overlapping_half_width(series: np.ndarray, size: int, confidence: float = CONFIDENCE) -> float:
    """Half-width of the mean's interval from all batches of ``size`` values that overlap; nan with too few values.

    1.5 times as many degrees of freedom as without overlap.
    Source: Meketon & Schmeiser 1984, Overlapping batch means: something for nothing? Winter Simulation Conference.
    """
    from scipy.special import stdtrit

    rows = rows_of(series)
    n = rows.shape[1]
    if n < 2 * size:
        return float("nan")
    summed = np.concatenate([np.zeros((rows.shape[0], 1)), np.cumsum(rows - rows.mean(), axis=1)], axis=1)
    means = (summed[:, size:] - summed[:, :-size]) / size
    # Deviations are from the common mean of all replications, which takes less of them away than each one's own would.
    of_one = size * np.mean(means**2) / (n - size / rows.shape[0])
    freedom = max(1.0, 1.5 * (rows.size / size - 1))
    return float(stdtrit(freedom, (1 + confidence) / 2) * np.sqrt(of_one / rows.shape[0]))
