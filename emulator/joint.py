"""The joint vector: posture, way, pace, duration, marks and bones side by side, each coordinate at unit spread."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

BLOCKS = ("posture", "root", "pace", "duration", "marks", "bones")


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
        """From raw parts {block: (N, k)} to the scale and z (N, K)."""
        raw = np.concatenate([parts[name] for name in BLOCKS], axis=1)
        spread = raw.std(axis=0, ddof=1)
        scale = cls(
            tuple(parts[name].shape[1] for name in BLOCKS), raw.mean(axis=0), np.where(spread > 1e-9, spread, 1.0)
        )
        return scale, (raw - scale.centre) / scale.spread

    def block(self, name: str) -> slice:
        """Where a block lies."""
        at = BLOCKS.index(name)
        start = sum(self.sizes[:at])
        return slice(start, start + self.sizes[at])

    def raw(self, z: np.ndarray, name: str) -> np.ndarray:
        """The raw coordinates (n, k) of one block of z (n, K)."""
        at = self.block(name)
        return self.centre[at] + self.spread[at] * z[..., at]
