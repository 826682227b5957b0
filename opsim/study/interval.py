"""Intervals from independent replications."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

CONFIDENCE = 0.95


@dataclass(frozen=True, slots=True)
class Interval:
    """A mean and its interval; ``half_width`` is nan where fewer than two of the ``n`` values are known."""

    mean: float
    half_width: float
    sd: float
    n: int

    @property
    def low(self) -> float:
        return self.mean - self.half_width

    @property
    def high(self) -> float:
        return self.mean + self.half_width


def t_interval(values: Sequence[float] | np.ndarray, confidence: float = CONFIDENCE) -> Interval:
    """Student's t interval of a mean from independent values; nan (nothing observed) is left out and shows in ``n``.

    Source: Law, Simulation Modeling and Analysis, 5th ed., eq. 4.12.
    """
    from scipy.special import stdtrit  # scipy.stats costs three times this import

    known = np.asarray(values, dtype=float)
    known = known[~np.isnan(known)]
    n = known.size
    if n == 0:
        return Interval(np.nan, np.nan, np.nan, 0)
    mean = float(known.mean())
    if n == 1:
        return Interval(mean, np.nan, np.nan, 1)
    sd = float(known.std(ddof=1))
    return Interval(mean, float(stdtrit(n - 1, (1 + confidence) / 2) * sd / np.sqrt(n)), sd, n)


@dataclass(frozen=True, slots=True)
class QuantileInterval:
    """A quantile's estimate and interval; ``low`` or ``high`` is infinite where ``n`` values are too few to bound it.

    coverage : the chance that the interval holds the quantile, at least the confidence asked for where both are finite
    """

    estimate: float
    low: float
    high: float
    coverage: float
    n: int


def quantile_interval(values: Sequence[float], q: float, confidence: float = CONFIDENCE) -> QuantileInterval:
    """Interval of the q-quantile of what the values were drawn from, whatever its distribution; nan is left out.

    Between two order statistics, each missed on its side with a chance of at most half of what is left.
    Source: Hahn & Meeker, Statistical Intervals, 1991, section 5.2.
    """
    from scipy.special import bdtr

    if not 0 < q < 1:
        raise ValueError(f"a quantile lies between 0 and 1, found {q:g}")
    known = np.asarray(values, dtype=float)
    known = np.sort(known[~np.isnan(known)])
    n = known.size
    if n == 0:
        return QuantileInterval(np.nan, -np.inf, np.inf, 1.0, 0)
    below = bdtr(np.arange(n), n, q)  # chance that at most i of n values lie below the quantile
    miss = (1 - confidence) / 2
    lower = int(np.count_nonzero(below <= miss))  # the lower-th smallest, from 1; 0 where there is none
    upper = int(np.count_nonzero(below < 1 - miss)) + 1  # n + 1 where there is none
    padded, reached = np.r_[-np.inf, known, np.inf], np.r_[0.0, below, 1.0]
    coverage = float(reached[upper] - reached[lower])
    return QuantileInterval(float(np.quantile(known, q)), float(padded[lower]), float(padded[upper]), coverage, n)
