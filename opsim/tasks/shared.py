"""Families from 0 upwards by mean and cv, in which workers may differ: lognormal, gamma, Weibull, hyperexponential."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from opsim.tasks.model import ByNumbers, SharedTime

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class Lognormal(ByNumbers, SharedTime):
    """Lognormal time; the share is that of the variance of log time.

    With v = ln(1 + cv^2) a worker's effect is b ~ N(0, share v), his log times ~ N(ln mean - v / 2 + b, (1 - share) v).
    """

    def numbers(self, worker: float | None) -> tuple[float, ...]:
        """Mean and standard deviation of the log of his times."""
        within = 1.0 if worker is None else 1.0 - self.between_share
        centre = math.log(self.mean_s) - self.log_variance / 2 + (0.0 if worker is None else worker)
        return centre, math.sqrt(within * self.log_variance)

    @staticmethod
    def _made_s(n: int, rng: np.random.Generator, *numbers: Any) -> np.ndarray:
        import numpy as np

        centre, spread = numbers
        return np.exp(centre + spread * rng.standard_normal(n))


@dataclass(frozen=True)
class Gamma(SharedTime):
    """Gamma time: shape 1 / cv^2, scale mean cv^2."""

    def _within_s(self, n: int, rng: np.random.Generator) -> np.ndarray:
        cv = self.within_cv
        return rng.gamma(cv**-2, self.mean_s * cv**2, n)


@dataclass(frozen=True)
class Weibull(SharedTime):
    """Weibull time with shape k: cv^2 = Gamma(1 + 2 / k) / Gamma(1 + 1 / k)^2 - 1, scale mean / Gamma(1 + 1 / k)."""

    def _within_s(self, n: int, rng: np.random.Generator) -> np.ndarray:
        shape = weibull_shape(self.within_cv)
        return self.mean_s / math.gamma(1 + 1 / shape) * rng.weibull(shape, n)


@dataclass(frozen=True)
class Hyperexponential(SharedTime):
    """Two exponentials with balanced means: with probability p the mean is m / 2p, else m / 2(1 - p); cv at least 1.

    p = (1 + sqrt((cv^2 - 1) / (cv^2 + 1))) / 2. Source: Tijms, A First Course in Stochastic Models (2003), p. 447.
    """

    def _within_s(self, n: int, rng: np.random.Generator) -> np.ndarray:
        import numpy as np

        p = balanced_probability(self.within_cv)
        short = rng.random(n) < p
        return rng.standard_exponential(n) * np.where(short, self.mean_s / (2 * p), self.mean_s / (2 * (1 - p)))


def balanced_probability(cv: float) -> float:
    """The probability of the shorter of two exponentials with balanced means."""
    return (1 + math.sqrt(max(0.0, (cv**2 - 1) / (cv**2 + 1)))) / 2


@lru_cache(maxsize=1024)
def weibull_shape(cv: float) -> float:
    """The shape k of a Weibull time with this cv (1e-5 to 1e3), by bisection of log k: cv falls as k grows."""
    low, high = math.log(0.05), math.log(2e5)
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if _weibull_log_variance(math.exp(middle)) > math.log1p(cv**2) else (low, middle)
    return math.exp((low + high) / 2)


def _weibull_log_variance(shape: float) -> float:
    """ln(1 + cv^2) of a Weibull time."""
    return math.lgamma(1 + 2 / shape) - 2 * math.lgamma(1 + 1 / shape)
