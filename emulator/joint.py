"""The joint vector: posture, way, pace, duration, marks, bones and dwells side by side, each at unit spread."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np

BLOCKS = ("posture", "root", "pace", "duration", "marks", "bones", "dwells")
CURVES = ("posture", "root", "pace")
"""The blocks that say curves over time."""


@dataclass(frozen=True)
class JointScale:
    """z = (raw - centre) / spread, and where each block of ``BLOCKS`` lies in it.

    sizes : number of coordinates of each block; centre, spread : (K,)
    A coordinate that never varies keeps spread 1.
    """

    sizes: tuple[int, ...]
    centre: np.ndarray
    spread: np.ndarray

    @classmethod
    def fit(cls, parts: dict[str, np.ndarray]) -> tuple[JointScale, np.ndarray]:
        """From raw parts {block: (N, k)} to the scale and z (N, K); a task without pauses gives no "dwells"."""
        parts = {"dwells": np.zeros((len(parts["duration"]), 0))} | parts
        raw = np.concatenate([parts[name] for name in BLOCKS], axis=1)
        spread = raw.std(axis=0, ddof=1)
        scale = cls(
            tuple(parts[name].shape[1] for name in BLOCKS), raw.mean(axis=0), np.where(spread > 1e-9, spread, 1.0)
        )
        return scale, (raw - scale.centre) / scale.spread

    def block(self, name: str) -> slice:
        """Where a block lies."""
        return self._blocks[name]

    @cached_property
    def _blocks(self) -> dict[str, slice]:
        ends = list(accumulate(self.sizes))
        return {name: slice(end - size, end) for name, end, size in zip(BLOCKS, ends, self.sizes)}

    def raw(self, z: np.ndarray, name: str) -> np.ndarray:
        """The raw coordinates (n, k) of one block of z (n, K)."""
        at = self.block(name)
        return self.centre[at] + self.spread[at] * z[..., at]
