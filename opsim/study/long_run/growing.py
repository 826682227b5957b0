"""Whether a series keeps growing, and whether that may still be luck."""

from __future__ import annotations

import numpy as np

from opsim.study.long_run.correlation import rows_of
from opsim.study.long_run.pieces import pieces

PIECES = 10
STEPS = 40
"""Pieces whose steps tell how far luck carries a series that nothing holds back."""


def growth(series: np.ndarray) -> tuple[float, float]:
    """(fitted growth over the whole series, one-sided p of no growth) by a line through the means of ten pieces.

    Replications are averaged first. p holds where the pieces are independent: a queue that is nearly full wanders, so
    that in a short run p is small far more often than it says.
    """
    from scipy.special import stdtr

    rows = rows_of(series)
    n = min(PIECES, rows.shape[1])
    if n < 4:
        return 0.0, 1.0
    means = pieces(rows, n).mean(axis=0)
    at = np.arange(n) - (n - 1) / 2
    slope = float(at @ means / (at @ at))
    rest = means - means.mean() - slope * at
    squares = float(rest @ rest)
    if squares <= 1e-18 * float(means @ means):
        return slope * n, 0.0 if abs(slope) > 1e-9 * float(np.max(np.abs(means))) and slope > 0 else 1.0
    t = slope / np.sqrt(squares / (n - 2) / (at @ at))
    return slope * n, float(stdtr(n - 2, -t))


def beyond_luck(series: np.ndarray) -> bool:
    """Whether a series grows more than it would by luck if as much left as comes: a load of exactly 1.

    At that load what piles up is a random walk that cannot fall below 0. It gets as far as |N(0, 1)| times the sd of
    all its steps together, 0.8 on average with an sd of 0.6; 2.2 / sqrt(replications) more than 0.8 is hardly luck
    (at a load of 1 one single run of a hundred). Below a load of 1 luck carries it less far.
    Source: Donsker's theorem and the reflection of Brownian motion (Billingsley, Convergence of probability measures).
    """
    rows = rows_of(series)
    n = min(STEPS, rows.shape[1])
    if n < 4:
        return False
    steps = np.diff(pieces(rows, n), axis=1)
    # Means of pieces of a random walk step by two thirds of the variance of its ends.
    sd = float(np.sqrt(1.5 * n * steps.var()))
    return growth(rows)[0] > sd * (0.8 + 2.2 / np.sqrt(rows.shape[0]))
