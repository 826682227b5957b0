"""Times without a body, a model each.

SharedTime : by mean and cv, a share of which may lie between workers: normal, beta, lognormal, gamma, Weibull,
             hyperexponential
TimeModel  : the same for all workers: fixed, exponential, geometric, Erlang, uniform, triangular; and times as they
             were seen: recorded (drawn again, or as a trace) and empirical (smoothed)
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from opsim.subjects.tasks.model import ByNumbers, SharedTime, TimeModel, UniformCount

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


@dataclass(frozen=True)
class Fixed(TimeModel):
    """Always this long."""

    duration_s: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return self.duration_s

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        import numpy as np

        return np.full(n, self.duration_s)


@dataclass(frozen=True)
class Exponential(ByNumbers, TimeModel):
    """Memoryless: cv 1."""

    mean_s: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return self.mean_s

    def numbers(self, worker: Any) -> tuple[float, ...]:
        return (self.mean_s,)

    @staticmethod
    def _made_s(n: int, rng: np.random.Generator, *numbers: Any) -> np.ndarray:
        (mean_s,) = numbers
        return rng.exponential(mean_s, n)


@dataclass(frozen=True)
class Geometric(TimeModel):
    """A whole number of steps from 1, the same chance step_s / mean_s to end after each: cv^2 = 1 - step_s / mean_s."""

    mean_s: float
    step_s: float

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.step_s > self.mean_s:
            raise ValueError(f"Geometric: step_s must be at most mean_s, found {self.step_s!r} and {self.mean_s!r}")

    def mean_duration_s(self, worker: Any = None) -> float:
        return self.mean_s

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return self.step_s * rng.geometric(self.step_s / self.mean_s, n)


@dataclass(frozen=True)
class Erlang(TimeModel):
    """The sum of k exponential phases of mean mean_s / k each: cv = 1 / sqrt(k)."""

    mean_s: float
    k: int

    def mean_duration_s(self, worker: Any = None) -> float:
        return self.mean_s

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return rng.gamma(self.k, self.mean_s / self.k, n)


@dataclass(frozen=True)
class Uniform(ByNumbers, TimeModel):
    """Anything from low to high, equally likely."""

    low_s: float
    high_s: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return (self.low_s + self.high_s) / 2

    def numbers(self, worker: Any) -> tuple[float, ...]:
        return self.low_s, self.high_s

    @staticmethod
    def _made_s(n: int, rng: np.random.Generator, *numbers: Any) -> np.ndarray:
        low_s, high_s = numbers
        return rng.uniform(low_s, high_s, n)


@dataclass(frozen=True)
class Triangular(TimeModel):
    """From low to high, most likely the mode: variance (a^2 + b^2 + c^2 - ab - ac - bc) / 18."""

    low_s: float
    mode_s: float
    high_s: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return (self.low_s + self.mode_s + self.high_s) / 3

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return rng.triangular(self.low_s, self.mode_s, self.high_s, n)


@dataclass(frozen=True)
class Recorded(TimeModel):
    """Recorded times: drawn again with replacement, or as a trace: performance k takes time k, then round again."""

    times_s: tuple[float, ...]
    by_index: bool = False

    def mean_duration_s(self, worker: Any = None) -> float:
        return math.fsum(self.times_s) / len(self.times_s)

    def at(self, k: np.ndarray) -> np.ndarray:
        """The times of performances k of a trace; after the last the trace begins again."""
        import numpy as np

        return np.asarray(self.times_s)[np.asarray(k) % len(self.times_s)]

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        import numpy as np

        return self.at(np.arange(n) if self.by_index else rng.integers(len(self.times_s), size=n))


@dataclass(frozen=True)
class Empirical(TimeModel):
    """The inverse of the empirical distribution function, made continuous: linear between the ordered values.

    The i-th of n ordered values has probability (i - 1/2) / n (Hazen); before the first and after the last the
    quantile stays at them, so nothing is drawn beyond what was seen. The mean is exactly that of the values; the
    variance is theirs (divided by n) less the sum of squared gaps between neighbours / 6n, some 1/n of it.
    """

    times_s: tuple[float, ...]
    _ordered_s: np.ndarray = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        import numpy as np

        object.__setattr__(self, "_ordered_s", np.sort(np.asarray(self.times_s, dtype=float)))

    def mean_duration_s(self, worker: Any = None) -> float:
        return math.fsum(self.times_s) / len(self.times_s)

    def quantile_s(self, probability: np.ndarray) -> np.ndarray:
        """The time below which this share of the performances lies."""
        import numpy as np

        n = self._ordered_s.size
        return np.interp(probability, (np.arange(n) + 0.5) / n, self._ordered_s)

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return self.quantile_s(rng.random(n))


def count_model(said: Any) -> TimeModel:
    """The model of a number of cycles as a scenario says it: always so many, geometric, or uniform."""
    from opsim.scenario.schema import GeometricCycles

    if isinstance(said, int):
        return Fixed(float(said))
    return Geometric(said.mean, 1.0) if isinstance(said, GeometricCycles) else UniformCount(said.low, said.high)
