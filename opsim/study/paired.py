"""Paired differences and their tests, one by one and held together; plain functions on arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from opsim.study.interval import Interval, t_interval

ROUNDING = 1e-9
"""Differences below this share of the values are of the order in which numbers were added, not of the variants."""
FEW = 10
"""Pairs: in fewer of them the same step everywhere may be luck, as with counts, and says nothing of the spread."""


def holm(p: Sequence[float]) -> np.ndarray:
    """(m,) p-values held against all m tests made; nan stays nan and does not count.

    Source: Holm 1979, A simple sequentially rejective multiple test procedure, Scand. J. Statist. 6:65-70.
    """
    alone = np.asarray(p, dtype=float)
    adjusted = np.full(alone.shape, np.nan)
    order = np.argsort(alone)[: np.count_nonzero(~np.isnan(alone))]
    steps = alone[order] * np.arange(order.size, 0, -1)
    adjusted[order] = np.minimum(1.0, np.maximum.accumulate(steps))
    return adjusted


def paired(a: Sequence[float], b: Sequence[float]) -> tuple[Interval, float, float | None]:
    """(interval of the mean of a - b, two-sided p, variance ratio) of pairs; a pair with a nan is left out.

    Differences that are all below ``ROUNDING`` of the values are taken for 0. Where a and b vary, and their difference
    does not in fewer than ``FEW`` pairs, p is nan; where neither varies, nothing is left to luck.
    """
    from scipy.special import stdtr  # scipy.stats costs three times this import

    pairs = np.array([a, b], dtype=float)
    pairs = pairs[:, ~np.isnan(pairs).any(axis=0)]
    apart_by = pairs[0] - pairs[1]
    least = ROUNDING * np.abs(pairs).max(initial=0)
    if np.abs(apart_by).max(initial=0) <= least:
        apart_by = np.zeros_like(apart_by)
    interval = t_interval(apart_by)
    if interval.n < 2:
        return interval, np.nan, None
    if interval.n < FEW and interval.mean != 0 and np.ptp(apart_by) <= least < np.ptp(pairs, axis=1).max():
        return interval, np.nan, None
    if interval.sd == 0:
        return interval, 1.0 if interval.mean == 0 else 0.0, None
    t = interval.mean / (interval.sd / np.sqrt(interval.n))
    apart = float(pairs.var(axis=1, ddof=1).sum())
    return interval, float(2 * stdtr(interval.n - 1, -abs(t))), apart / interval.sd**2 if apart > 0 else None


def paired_with_each(one: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """As ``paired`` of one variant and each of many others: (means of one - other, p, whether identical).

    one : (F, n) figures in n replications; others : (M, F, n); each of the results : (M, F)
    """
    from scipy.special import stdtr

    by = one[None] - others
    known = ~np.isnan(by)
    n = known.sum(axis=-1)
    a, b = np.where(known, one[None], 0.0), np.where(known, others, 0.0)
    least = ROUNDING * np.maximum(np.abs(a), np.abs(b)).max(axis=-1, initial=0.0)
    by = np.where(known, by, 0.0)
    by = np.where((np.abs(by).max(axis=-1, initial=0.0) <= least)[..., None], 0.0, by)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = by.sum(axis=-1) / n
        sd = np.sqrt((np.where(known, by - mean[..., None], 0.0) ** 2).sum(axis=-1) / (n - 1))
        p = 2 * stdtr(n - 1.0, -np.abs(mean) / (sd / np.sqrt(n)))
    even = _reach(by, known) <= least
    sd = np.where(even, 0.0, sd)
    p = np.where(even, np.where(mean == 0, 1.0, 0.0), p)
    varies = least < np.maximum(_reach(a, known), _reach(b, known))
    p = np.where((n < 2) | ((n < FEW) & (mean != 0) & even & varies), np.nan, p)
    return mean, p, (n > 0) & (mean == 0) & even


def _reach(values: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Largest minus smallest known value along the last axis; 0 where none is known."""
    low = np.where(known, values, np.inf).min(axis=-1, initial=np.inf)
    high = np.where(known, values, -np.inf).max(axis=-1, initial=-np.inf)
    return np.where(known.any(axis=-1), high - low, 0.0)
