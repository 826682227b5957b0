"""The best of the points, and which others are not told from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.kpi.better import LESS, MORE
from opsim.study.interval import CONFIDENCE, Interval
from opsim.study.paired import holm, paired


@dataclass(frozen=True, slots=True)
class Best:
    """The point that is best in the replications that both of a pair have; ``like_it`` other points are not told from
    it (paired, all together, Holm). shared : the fewest replications that it has together with another point
    """

    row: int
    mean: Interval
    like_it: int
    better: str
    shared: int


def best_of(values: np.ndarray, means: Sequence[Interval], better: str) -> Best:
    """The best point, and how many others are not told from it. values : (P, n), nan where a figure has no value"""
    row = _champion(values * {MORE: 1.0, LESS: -1.0}[better], means)
    tests = [paired(values[row], other) for place, other in enumerate(values) if place != row]
    p = holm([np.nan if i.n > 0 and i.mean == 0 and i.sd == 0 else p for i, p, _ in tests])
    ahead = np.array([i.mean for i, _, _ in tests]) * {MORE: 1.0, LESS: -1.0}[better] > 0
    clear = int(np.count_nonzero((p <= 1 - CONFIDENCE) & ahead))
    return Best(row, means[row], len(tests) - clear, better, min((i.n for i, _, _ in tests if i.n), default=0))


def _champion(values: np.ndarray, means: Sequence[Interval]) -> int:
    """The row that is highest; where values are missing, the last that beat the one before it in what both have.

    Means over different replications would compare their luck. values : (P, n), more is better
    """
    with np.errstate(invalid="ignore"):
        whole = np.array([np.nan if not one.n else np.nanmean(row) for row, one in zip(values, means)])
    row = int(np.nanargmax(whole))
    if np.isnan(values).any():
        for other in range(len(values)):
            by = values[other] - values[row]
            if not np.isnan(by).all() and np.nanmean(by) > 0:
                row = other
    return row
