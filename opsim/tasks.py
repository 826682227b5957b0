"""Times without a body: fixed, drawn from a distribution, or recorded. Each satisfies the seam of ``opsim.task``.

All draws of a call are made at once, in one fixed order. A worker's effect is a shift of log time (Lognormal with
``between_share``); the other models have none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from opsim.libraries import load_library, resolve_library
from opsim.recorded import read_times, resolve_times

if TYPE_CHECKING:
    from opsim.scenario.read import Loaded

# A drawn time is never 0: the engine's clock has this as its smallest step.
SMALLEST_S = 2.0**-20


@dataclass(frozen=True, slots=True)
class TimePerformances:
    """n performances that are times only: ``duration_s`` (n,) > 0; no marks, no scores, no skeleton."""

    duration_s: np.ndarray
    skeleton: None = None

    @property
    def mark_s(self) -> np.ndarray:
        return np.empty((self.duration_s.size, 0))

    @property
    def scores(self) -> np.ndarray:
        return np.empty((self.duration_s.size, 0))

    def directions(self, *args: Any, **kwargs: Any) -> np.ndarray:
        raise ValueError("a time without a body has no postures; use an emulator task")

    positions_m = root_m = directions


class _TimeModel:
    """What the time models share: no worker effect, and ``sample`` from their own draws."""

    def mean_duration_s(self, worker: Any = None) -> float:
        """The mean in seconds; of this worker, where workers differ."""
        raise NotImplementedError

    def draw_worker(self, rng: np.random.Generator, body: Any = None) -> Any:
        """A worker's own effect, to be passed back as ``worker=``; None: workers do not differ."""
        return None

    def sample(
        self, n: int, rng: np.random.Generator, *, worker: Any = None, condition: Any = None
    ) -> TimePerformances:
        """n performances; the same generator gives the same n."""
        if condition is not None:
            raise ValueError(f"{type(self).__name__}: a time without a body knows no condition, found {condition!r}")
        return TimePerformances(np.maximum(self._draw_s(n, rng, worker), SMALLEST_S))

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        raise NotImplementedError


@dataclass(frozen=True)
class Fixed(_TimeModel):
    """Always this long."""

    duration_s: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return self.duration_s

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return np.full(n, self.duration_s)


@dataclass(frozen=True)
class Exponential(_TimeModel):
    mean_s: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return self.mean_s

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return rng.exponential(self.mean_s, n)


@dataclass(frozen=True)
class Lognormal(_TimeModel):
    """Lognormal time with mean and cv of the population; a share of the variance of log time lies between workers.

    s2 = ln(1 + cv^2); a worker's effect b ~ N(0, share s2); his log times ~ N(ln mean - s2 / 2 + b, (1 - share) s2).
    The population's mean is ``mean_s`` whatever the share; a worker's mean is mean_s exp(b - share s2 / 2).
    Without a worker the times are those of the population, each from a worker of its own.
    """

    mean_s: float
    cv: float
    between_share: float = 0.0

    @property
    def log_variance(self) -> float:
        return math.log1p(self.cv**2)

    def mean_duration_s(self, worker: float | None = None) -> float:
        if worker is None:
            return self.mean_s
        return self.mean_s * math.exp(worker - self.between_share * self.log_variance / 2)

    def draw_worker(self, rng: np.random.Generator, body: Any = None) -> float | None:
        if self.between_share == 0:
            return None
        return float(rng.normal(0.0, math.sqrt(self.between_share * self.log_variance)))

    def _draw_s(self, n: int, rng: np.random.Generator, worker: float | None) -> np.ndarray:
        within = 1.0 if worker is None else 1.0 - self.between_share
        centre = math.log(self.mean_s) - self.log_variance / 2 + (0.0 if worker is None else worker)
        return np.exp(centre + math.sqrt(within * self.log_variance) * rng.standard_normal(n))


@dataclass(frozen=True)
class Gamma(_TimeModel):
    """Gamma time: shape 1 / cv^2, scale mean cv^2."""

    mean_s: float
    cv: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return self.mean_s

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return rng.gamma(self.cv**-2, self.mean_s * self.cv**2, n)


@dataclass(frozen=True)
class Uniform(_TimeModel):
    low_s: float
    high_s: float

    def mean_duration_s(self, worker: Any = None) -> float:
        return (self.low_s + self.high_s) / 2

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return rng.uniform(self.low_s, self.high_s, n)


@dataclass(frozen=True)
class Recorded(_TimeModel):
    """Recorded times: drawn again with replacement, or as a trace: performance k takes time k, then round again."""

    times_s: tuple[float, ...]
    by_index: bool = False

    def mean_duration_s(self, worker: Any = None) -> float:
        return math.fsum(self.times_s) / len(self.times_s)

    def at(self, k: np.ndarray) -> np.ndarray:
        """The times of performances k of a trace; after the last the trace begins again."""
        return np.asarray(self.times_s)[np.asarray(k) % len(self.times_s)]

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return self.at(np.arange(n) if self.by_index else rng.integers(len(self.times_s), size=n))


def task_model(task: Any, loaded: Loaded) -> Any:
    """The TaskModel of a task of a scenario; an emulated one comes out of its library."""
    from opsim.scenario import schema

    match task:
        case schema.Fixed():
            return Fixed(task.fixed_s)
        case schema.Exponential():
            return Exponential(task.mean_s)
        case schema.Lognormal():
            return Lognormal(task.mean_s, task.cv, task.between_share)
        case schema.Gamma():
            return Gamma(task.mean_s, task.cv)
        case schema.Uniform():
            return Uniform(task.low_s, task.high_s)
        case schema.Recorded():
            times = read_times(resolve_times(task.recorded, loaded.folder), task.column)
            return Recorded(tuple(times), by_index=task.by == "trace")
        case schema.Emulated():
            file = resolve_library(loaded.scenario.libraries[task.library], loaded.folder)
            return load_library(file)[task.library_task]
    raise TypeError(f"no model for a {type(task).__name__}")
