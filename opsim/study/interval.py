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


def t_interval(values: Sequence[float], confidence: float = CONFIDENCE) -> Interval:
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
    return Interval(mean, float(stdtrit(n - 1, (1 + confidence) / 2)) * sd / np.sqrt(n), sd, n)
