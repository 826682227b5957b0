"""By how much a fit misses: points left out (PRESS), lack of fit, pure error, misfit.

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


def lack_of_fit(design: np.ndarray, y: np.ndarray) -> float:
    """p of the F test that luck alone explains by how much the points are missed; nan where n is 1 or no point spare.

    design : (P, C); y : (P, n) of replications with common random numbers. Source: ``pure_error``.
    """
    from scipy.special import fdtrc

    n, spare = y.shape[1], design.shape[0] - design.shape[1]
    if n < 2 or spare < 1:
        return float("nan")
    pure, lack = pure_error(design, y), n * _mean_square(design, y)
    tiny = (1e-9 * np.abs(y).max(initial=0)) ** 2
    if pure <= tiny:
        return 1.0 if lack <= tiny else 0.0
    return float(fdtrc(spare, (n - 1) * spare, lack / pure))


def pure_error(design: np.ndarray, y: np.ndarray) -> float:
    """Variance of one replication at one point around that replication's own fit; nan where n is 1.

    Each replication has a fit of its own, so luck that is common to all points, or that tilts or bends them as the fit
    can, is no pure error: with common random numbers it is most of the luck, and would hide what the fit misses.
    Source: Kleijnen 2015, section 3.4 (replications fitted one by one); the F test is that of Montgomery, 10.8.
    """
    (points, terms), n = design.shape, y.shape[1]
    if n < 2 or points <= terms:
        return float("nan")
    misses = _each_residual(design, y)
    return float(((misses - misses.mean(axis=1, keepdims=True)) ** 2).sum()) / ((n - 1) * (points - terms))


def misfit(design: np.ndarray, y: np.ndarray) -> float:
    """Variance by which the truth at a point lies beside the best fit: what the misses have beyond luck, at least 0.

    Of one replication luck cannot be told, so all of the misses counts.
    """
    luck = pure_error(design, y) / y.shape[1] if y.shape[1] > 1 else 0.0
    return max(0.0, _mean_square(design, y) - luck)


def block_error(y: np.ndarray) -> float:
    """Variance of one replication at one point, apart from what is common to a point or a replication; y : (P, n).

    Source: Montgomery, 8th ed., section 4.1 (randomised blocks).
    """
    points, n = y.shape
    if n < 2 or points < 2:
        return float("nan")
    left = y - y.mean(axis=1, keepdims=True) - y.mean(axis=0, keepdims=True) + y.mean()
    return float((left**2).sum()) / ((points - 1) * (n - 1))


def _mean_square(design: np.ndarray, y: np.ndarray) -> float:
    """Of the misses of the means."""
    misses = residuals(design, y.mean(axis=1))
    return float(misses @ misses) / (design.shape[0] - design.shape[1])


def _each_residual(design: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(P, n) by how much each replication's own fit misses it."""
    return np.asarray(y - design @ np.linalg.lstsq(design, y, rcond=None)[0])


def t_of(degrees: int) -> float:
    """Student's quantile of a two-sided interval."""
    from scipy.special import stdtrit

    return float(stdtrit(max(1, degrees), (1 + CONFIDENCE) / 2))
