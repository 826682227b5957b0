"""How long a cycle takes: the lag after which a movement is most like itself."""

from __future__ import annotations

import numpy as np

APART = 0.5
"""Before it comes back, a movement must have gone this far: 1 is as unlike as two frames at random."""
ALIKE = 0.6
"""Come back is nearer than this."""
AS_GOOD = 0.15
"""The first return that is as good as the best, but for this share of the way from the best to the worst."""
LONGEST_SHARE = 0.6
"""Of the take: there must be more than one cycle and a half to be sure of it."""


def unlikeness(points: np.ndarray) -> np.ndarray:
    """Mean squared distance of frames a lag apart, over twice the variance: 0 alike, 1 as two frames at random.

    points  : (n, m)
    returns : (L,) for lags 0 to LONGEST_SHARE n, by the fast Fourier transform
    """
    n = len(points)
    lags = np.arange(int(LONGEST_SHARE * n) + 1)
    centred = points - points.mean(axis=0)
    size = 1 << (2 * n - 1).bit_length()
    power = (np.abs(np.fft.rfft(centred, size, axis=0)) ** 2).sum(axis=1)
    products = np.fft.irfft(power, size)[lags]
    sums = np.concatenate([[0.0], np.cumsum(np.einsum("tm,tm->t", centred, centred))])
    whole = sums[n - lags] + sums[n] - sums[lags]
    return np.maximum(1.0 - 2.0 * products / np.maximum(whole, 1e-300), 0.0)


def period_frames(points: np.ndarray) -> int | None:
    """Frames a cycle, or None where the movement does not come back to itself."""
    unlike = unlikeness(points)
    dips = [
        lag
        for lag in range(2, len(unlike) - 1)
        if unlike[lag] <= unlike[lag - 1] and unlike[lag] < unlike[lag + 1] and unlike[:lag].max() > APART
    ]
    dips = [lag for lag in dips if unlike[lag] < ALIKE]
    if not dips:
        return None
    best = min(unlike[lag] for lag in dips)
    return next(lag for lag in dips if unlike[lag] <= best + AS_GOOD * (unlike.max() - best))
