"""Times with bounds, in which workers may differ: the normal cut off below, and the beta."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

from opsim.tasks.model import SharedTime

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Normal(SharedTime):
    """Normal N(mu, sigma^2) cut off below ``low_s``; mean and cv are those after the cut.

    With a = (low - mu) / sigma and the hazard h = phi(a) / (1 - Phi(a)): mean = mu + sigma h and
    var = sigma^2 (1 + a h - h^2). Drawn by inversion in the upper tail, one uniform a time.
    Source: Johnson, Kotz & Balakrishnan, Continuous Univariate Distributions 1 (1994), section 10.1.
    """

    low_s: float = 0.0

    def _within_s(self, n: int, rng: np.random.Generator) -> np.ndarray:
        import numpy as np
        from scipy.special import ndtr, ndtri

        a, sigma_s = self._cut()
        upper = (1.0 - rng.random(n)) * ndtr(-a)
        return np.maximum(self.low_s - a * sigma_s - sigma_s * ndtri(upper), self.low_s)

    def _cut(self) -> tuple[float, float]:
        """Where the parent normal is cut, in its own standard deviations, and its standard deviation."""
        sd_s = self.within_cv * self.mean_s
        a = normal_cut((self.mean_s - self.low_s) / sd_s)
        return a, (self.mean_s - self.low_s) / (_hazard(a) - a)


@dataclass(frozen=True)
class Beta(SharedTime):
    """Beta time from ``low_s`` to ``high_s`` with the given mean and cv (of one worker of average pace)."""

    low_s: float = 0.0
    high_s: float = math.inf

    def _within_s(self, n: int, rng: np.random.Generator) -> np.ndarray:
        alpha, beta = self._shapes()
        return self.low_s + (self.high_s - self.low_s) * rng.beta(alpha, beta, n)

    def _shapes(self) -> tuple[float, float]:
        """By moments: with mean m and variance v on (0, 1), alpha + beta = m (1 - m) / v - 1."""
        width_s = self.high_s - self.low_s
        m, v = (self.mean_s - self.low_s) / width_s, (self.within_cv * self.mean_s / width_s) ** 2
        both = m * (1 - m) / v - 1
        return m * both, (1 - m) * both


@lru_cache(maxsize=1024)
def normal_cut(ratio: float) -> float:
    """The cut a at which (mean - low) / sd of what remains is ``ratio`` > 1: it falls from infinity to 1 as a grows."""
    if ratio > 40:  # nothing is cut off that a double could show
        return -ratio
    low, high = -ratio - 1.0, 100.0
    for _ in range(100):
        a = (low + high) / 2
        low, high = (a, high) if _ratio(a) > ratio else (low, a)
    return (low + high) / 2


def _ratio(a: float) -> float:
    hazard = _hazard(a)
    return (hazard - a) / math.sqrt(1 + a * hazard - hazard**2)


def _hazard(a: float) -> float:
    """phi(a) / (1 - Phi(a)), to full precision in the tail."""
    from scipy.special import erfcx

    return math.sqrt(2 / math.pi) / float(erfcx(a / math.sqrt(2)))
