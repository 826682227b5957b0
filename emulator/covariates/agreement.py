"""Do two curves agree? Intraclass correlation and standard error of measurement of a true and a foretold angle."""

from __future__ import annotations

import numpy as np


def icc_2_1(true: np.ndarray, foretold: np.ndarray) -> np.ndarray:
    """Absolute agreement ICC(2,1) of curves (..., T) over their moments, (...); 1 is the same curve.

    Moments are the targets, the two curves the raters. NaN moments (an angle that says nothing) are left out; NaN for
    fewer than three moments or two curves that never move. Source: Shrout & Fleiss (1979), case 2, single rater.
    """
    pair = np.stack([true, foretold], axis=-1)
    there = np.all(np.isfinite(pair), axis=-1)
    n = there.sum(axis=-1)
    pair = np.where(there[..., None], pair, 0.0)
    enough = np.maximum(n, 1)
    rater = pair.sum(axis=-2) / enough[..., None]
    grand = rater.mean(axis=-1)
    target = np.where(there, pair.mean(axis=-1), grand[..., None])
    rows = 2.0 * np.sum((target - grand[..., None]) ** 2, axis=-1) / np.maximum(n - 1, 1)
    columns = enough * np.sum((rater - grand[..., None]) ** 2, axis=-1)
    fit = target[..., None] + rater[..., None, :] - grand[..., None, None]
    rest = np.sum(np.where(there[..., None], pair - fit, 0.0) ** 2, axis=(-2, -1)) / np.maximum(n - 1, 1)
    below = rows + rest + 2.0 * (columns - rest) / enough
    return np.where((n >= 3) & (below > 0), (rows - rest) / np.where(below > 0, below, 1.0), np.nan)


def icc_of_the_paper(true: np.ndarray, foretold: np.ndarray) -> np.ndarray:
    """Formula (7) of Baydal-Bertomeu et al., (...): var(foretold) / (var(true) + var(foretold)) of curves (..., T).

    It is 1/2 for a perfect forecast and for any other of the right size, so their 0.91 cannot have come from it as
    printed. Here to be quoted beside ``icc_2_1``, not to be judged by.
    """
    there = np.isfinite(true) & np.isfinite(foretold)
    one, other = (_variance(np.where(there, curve, np.nan)) for curve in (true, foretold))
    whole = one + other
    return np.where(whole > 0, other / np.where(whole > 0, whole, 1.0), np.nan)


def sem(true: np.ndarray, foretold: np.ndarray, icc: np.ndarray) -> np.ndarray:
    """Standard error of measurement (...), in the unit of the curves (..., T): combined s.d. times sqrt(1 - ICC).

    Source: Baydal-Bertomeu et al., eq. 8, sigma_c as the s.d. of both curves' moments; 0 for the same constant.
    """
    there = np.isfinite(true) & np.isfinite(foretold)
    both = np.concatenate([np.where(there, true, np.nan), np.where(there, foretold, np.nan)], axis=-1)
    spread = np.sqrt(_variance(both))
    return np.where(spread > 0, spread * np.sqrt(np.maximum(1.0 - icc, 0.0)), 0.0)


def rms(true: np.ndarray, foretold: np.ndarray) -> np.ndarray:
    """Root of the mean squared difference (...) of curves (..., T), over the moments that both have."""
    square = (true - foretold) ** 2
    n = np.sum(np.isfinite(square), axis=-1)
    return np.where(n > 0, np.sqrt(np.nansum(square, axis=-1) / np.maximum(n, 1)), np.nan)


def _variance(curves: np.ndarray) -> np.ndarray:
    """(...) variance over the finite moments of (..., T), about their mean, n - 1 in the denominator."""
    n = np.sum(np.isfinite(curves), axis=-1)
    mean = np.nansum(curves, axis=-1) / np.maximum(n, 1)
    return np.nansum((curves - mean[..., None]) ** 2, axis=-1) / np.maximum(n - 1, 1)
