"""Times as they were seen: drawn again, replayed as a trace, or from their smoothed distribution."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from opsim.tasks.model import TimeModel

if TYPE_CHECKING:
    import numpy as np


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
