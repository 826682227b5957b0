"""By how much a fit misses: points left out (PRESS), lack of fit, pure error.

Source: Montgomery, Design and Analysis of Experiments, 8th ed., sections 10.7 and 10.8.
"""

from __future__ import annotations

import numpy as np

from opsim.study.interval import CONFIDENCE


def leaves_one_out(design: np.ndarray) -> bool:
    """Whether the fit exists, and still does without any one of its points."""
    points, terms = design.shape
    return points > terms and np.linalg.matrix_rank(design) == terms and bool((_leverage(design) < 1 - 1e-9).all())


def _leverage(design: np.ndarray) -> np.ndarray:
    """(P,) how much a point pulls the fit to itself: the diagonal of the hat matrix."""
    q, _ = np.linalg.qr(design)
    return np.asarray((q**2).sum(axis=1))


def press_of(design: np.ndarray, means: np.ndarray) -> float:
    """Sum of squares by which points are missed by the fit without them; no fit is done again (Montgomery, 10.7)."""
    left_out = residuals(design, means) / (1 - _leverage(design))
    return float(left_out @ left_out)


def residuals(design: np.ndarray, means: np.ndarray) -> np.ndarray:
    """(P,) by how much the least-squares fit misses the points that it was fitted to."""
    return np.asarray(means - design @ np.linalg.lstsq(design, means, rcond=None)[0])


def lack_of_fit(misses: np.ndarray, y: np.ndarray, spare: int) -> float:
    """p of the F test that noise alone explains by how much the points are missed; nan where n or ``spare`` is 1 or 0.

    misses : (P,) of the means; y : (P, n). Replications are blocks, so that luck common to all points is no pure error.
    Source: Montgomery, 8th ed., section 10.8.2, with the pure error of a randomised block design (section 4.1).
    """
    from scipy.special import fdtrc

    points, n = y.shape
    if n < 2 or spare < 1:
        return float("nan")
    pure = pure_error(y)
    lack = n * float(misses @ misses) / spare
    tiny = (1e-9 * np.abs(y).max(initial=0)) ** 2
    if pure <= tiny:
        return 1.0 if lack <= tiny else 0.0
    return float(fdtrc(spare, (points - 1) * (n - 1), lack / pure))


def pure_error(y: np.ndarray) -> float:
    """Variance of one replication at one point, apart from what is common to a point or a replication; y : (P, n)."""
    points, n = y.shape
    if n < 2 or points < 2:
        return float("nan")
    left = y - y.mean(axis=1, keepdims=True) - y.mean(axis=0, keepdims=True) + y.mean()
    return float((left**2).sum()) / ((points - 1) * (n - 1))


def t_of(degrees: int) -> float:
    """Student's quantile of a two-sided interval."""
    from scipy.special import stdtrit

    return float(stdtrit(max(1, degrees), (1 + CONFIDENCE) / 2))
