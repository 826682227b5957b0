"""Models of one coefficient vector a sequence: MVG, IG and Kernel; the start posture is part of the vector."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from emulator.density import LowRankNormal
from emulator.schemes.kernel import KernelDensity


class Density(Protocol):
    def sample(self, n: int, rng: np.random.Generator) -> np.ndarray: ...
    def log_likelihood(self, scores: np.ndarray) -> np.ndarray: ...


@dataclass(frozen=True)
class VectorModel:
    """One density of scores (n, K) and start scores (n, S) side by side.

    MVG draws them together, so that alpha(0) goes with what follows; IG draws every number by itself.
    Source: Chen, Park & Srivastava sec. 4.3.1; it does not say how alpha(0) is drawn.
    """

    density: Density
    n_scores: int

    @classmethod
    def fit(cls, name: str, scores: np.ndarray, start: np.ndarray, rho: float = 0.0) -> VectorModel:
        """The density MVG, IG or Kernel of scores (N, K) and start (N, S). ``rho`` shrinks the correlations of MVG."""
        rows = np.concatenate([scores, start], axis=-1)
        density: Density = (
            KernelDensity.fit(rows) if name == "Kernel" else LowRankNormal.fit(rows, 1.0 if name == "IG" else rho)
        )
        return cls(density, scores.shape[-1])

    def sample(
        self, n: int, rng: np.random.Generator, *, allow_unstable: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """n scores (n, K) and start scores (n, S)."""
        rows = self.density.sample(n, rng)
        return rows[:, : self.n_scores], rows[:, self.n_scores :]

    def log_likelihood(self, scores: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Log density (...,) of both together, in the subspace of the training."""
        return self.density.log_likelihood(np.concatenate([scores, start], axis=-1))
