"""Denoising: points of a curve further than a threshold from the fitted one are pulled back to it.

Source: spatio-temporal LTSA (seed 003), sec. 3.2 and its equation for the translation.
"""

from __future__ import annotations

import numpy as np


def fitted_curve(y: np.ndarray, period: float, knots_a_cycle: float = 6.0) -> np.ndarray:
    """The least-squares cubic spline (n,) through a curve y (n,), with even knots."""
    from scipy.interpolate import make_lsq_spline

    n = len(y)
    pieces = int(np.clip(round(knots_a_cycle * n / period), 1, max(1, n // 2 - 3)))
    inner = np.linspace(0, n - 1, pieces + 1)[1:-1]
    knots = np.concatenate([np.zeros(4), inner, np.full(4, n - 1.0)])
    at = np.arange(n, dtype=float)
    return np.asarray(make_lsq_spline(at, y, knots, k=3)(at))


def denoised(y: np.ndarray, fitted: np.ndarray, threshold: float | None = None) -> tuple[np.ndarray, np.ndarray]:
    """The curve with noisy points translated towards the fitted one, and which these are, (n,) bool.

    threshold : points further from the fitted curve are noisy; None: twice the median distance
    Each is moved by the mean distance of all noisy points, as in the paper, but never past the fitted curve.
    """
    away = y - fitted
    far = np.abs(away)
    noisy = far > (2.0 * float(np.median(far)) if threshold is None else threshold)
    if not noisy.any():
        return y.copy(), noisy
    step = float(far[noisy].mean())
    moved = np.where(far > step, y - np.sign(away) * step, fitted)
    return np.where(noisy, moved, y), noisy
