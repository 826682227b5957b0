"""What all times without a body share: performances that are times only, and workers who may differ in pace.

All draws of a call are made at once, in one fixed order. A worker's effect is a shift b of his log time.

Whole numbers drawn by the same seam as times, such as cycles between two breakdowns: one second stands for one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real
from typing import TYPE_CHECKING, Any, ClassVar

from opsim.task_model import log_variance, within_cv

if TYPE_CHECKING:
    import numpy as np

# A drawn time is never 0: the engine's clock has this as its smallest step.
SMALLEST_S = 2.0**-20


@dataclass(frozen=True, slots=True)
class TimePerformances:
    """n performances that are times only: ``duration_s`` (n,) > 0; no marks, no scores, no skeleton."""

    duration_s: np.ndarray
    skeleton: None = None

    @property
    def mark_s(self) -> np.ndarray:
        return self._nothing()

    @property
    def scores(self) -> np.ndarray:
        return self._nothing()

    def _nothing(self) -> np.ndarray:
        import numpy as np

        return np.empty((self.duration_s.size, 0))

    def directions(self, *args: Any, **kwargs: Any) -> np.ndarray:
        raise ValueError("a time without a body has no postures; use an emulator task")

    positions_m = root_m = directions


_TIME = ("a time in seconds above 0", lambda value: 0 < value < math.inf)
_WANTED = {
    **dict.fromkeys(("mean_s", "duration_s", "step_s"), _TIME),
    **dict.fromkeys(("low_s", "mode_s"), ("a time in seconds from 0", lambda value: 0 <= value < math.inf)),
    "high_s": ("a time in seconds above 0", lambda value: value > 0),
    "cv": ("a number from 0", lambda value: 0 <= value < math.inf),
    "between_share": ("a share from 0 to 1", lambda value: 0 <= value <= 1),
    "k": ("a whole number from 1", lambda value: value >= 1 and value == int(value)),
}


class TimeModel:
    """No worker effect, and ``sample`` from the model's own draws.

    Raises TypeError or ValueError where a parameter is no time, no spread, no share or no count.
    """

    body_keys: ClassVar[tuple[str, ...]] = ()
    """Nothing of a worker's body is read."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if name in _WANTED:
                wanted, holds = _WANTED[name]
                if isinstance(value, bool) or not isinstance(value, Real):
                    raise TypeError(f"{type(self).__name__}: {name} must be {wanted}, found {value!r}")
                if not holds(value):
                    raise ValueError(f"{type(self).__name__}: {name} must be {wanted}, found {value!r}")

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
        return TimePerformances(_at_least_smallest_s(self._draw_s(n, rng, worker)))

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        raise NotImplementedError


class ByNumbers:
    """A family of times that differ by a few numbers alone, so that those of many models can be drawn at once."""

    def numbers(self, worker: Any) -> tuple[float, ...]:
        """By which the times of this worker differ from others of the family."""
        raise NotImplementedError

    @staticmethod
    def _made_s(n: int, rng: np.random.Generator, *numbers: Any) -> np.ndarray:
        """Each time from luck of its own and from numbers, or arrays (n,) of them."""
        raise NotImplementedError

    def _draw_s(self, n: int, rng: np.random.Generator, worker: Any) -> np.ndarray:
        return self._made_s(n, rng, *self.numbers(worker))

    @classmethod
    def sample_side_by_side_s(cls, n: int, rng: np.random.Generator, *numbers: Any) -> np.ndarray:
        """(n,) times of several models, or workers: as ``sample`` gives them."""
        return _at_least_smallest_s(cls._made_s(n, rng, *numbers))


def _at_least_smallest_s(duration_s: np.ndarray) -> np.ndarray:
    import numpy as np

    return np.maximum(duration_s, SMALLEST_S)


@dataclass(frozen=True)
class SharedTime(TimeModel):
    """A family by mean and cv; a share of the log variance ln(1 + cv^2) lies between workers.

    A worker's effect is b ~ N(0, s2) with s2 = between_share ln(1 + cv^2); his times are exp(b - s2 / 2) times a draw
    of the family with mean ``mean_s`` and the smaller cv of ``opsim.task_model``; so mean and cv over the population
    are exactly those given, whatever the share. Without a worker, every time is that of a worker of its own.
    A child gives ``_within_s``: n times with mean ``mean_s`` and cv ``self.within_cv``.
    """

    mean_s: float
    cv: float
    between_share: float = 0.0

    @property
    def log_variance(self) -> float:
        return log_variance(self.cv)

    @property
    def within_cv(self) -> float:
        """cv of one worker's times."""
        return within_cv(self.cv, self.between_share)

    @property
    def _between(self) -> float:
        return self.between_share * self.log_variance

    def mean_duration_s(self, worker: float | None = None) -> float:
        return self.mean_s if worker is None else self.mean_s * math.exp(worker - self._between / 2)

    @property
    def knows_slowness(self) -> bool:
        """``draw_worker`` takes ``slowness``."""
        return True

    def draw_worker(self, rng: np.random.Generator, body: Any = None, slowness: float | None = None) -> float | None:
        """The shift b of a worker's log time; ``slowness``: at so many standard deviations from the mean, no luck."""
        if not self.between_share:
            return None
        spread = math.sqrt(self._between)
        return float(rng.normal(0.0, spread)) if slowness is None else spread * slowness

    def _draw_s(self, n: int, rng: np.random.Generator, worker: float | None) -> np.ndarray:
        import numpy as np

        own_s = self._within_s(n, rng) if self.within_cv > 0 else np.full(n, self.mean_s)
        if not self.between_share:
            return own_s
        shift = rng.normal(0.0, math.sqrt(self._between), n) if worker is None else worker
        return own_s * np.exp(shift - self._between / 2)

    def _within_s(self, n: int, rng: np.random.Generator) -> np.ndarray:
        raise NotImplementedError


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
