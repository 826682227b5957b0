"""Times in which workers do not differ: fixed, exponential, geometric, Erlang, uniform, triangular."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from opsim.tasks.model import ByNumbers, TimeModel

if TYPE_CHECKING:
    import numpy as np


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
