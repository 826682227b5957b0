"""Whole numbers drawn by the same seam as times, such as cycles between two breakdowns: one second stands for one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from opsim.tasks.model import TimeModel

if TYPE_CHECKING:
    import numpy as np


@dataclass(frozen=True)
class UniformCount(TimeModel):
    """A whole number from low to high, both included, equally likely."""

    low: int
    high: int

    def __post_init__(self) -> None:
        if not 1 <= self.low <= self.high:
            raise ValueError(f"UniformCount: must be 1 <= low <= high, found {self.low!r} and {self.high!r}")

    def mean_duration_s(self, worker: Any = None) -> float:
        return (self.low + self.high) / 2

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return rng.integers(self.low, self.high, n, endpoint=True).astype(float)


def count_model(said: Any) -> TimeModel:
    """The model of a number of cycles as a scenario says it: always so many, geometric, or uniform."""
    from opsim.scenario.schema import GeometricCycles
    from opsim.tasks.simple import Fixed, Geometric

    if isinstance(said, int):
        return Fixed(float(said))
    return Geometric(said.mean, 1.0) if isinstance(said, GeometricCycles) else UniformCount(said.low, said.high)
