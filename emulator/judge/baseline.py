"""What to be better than: the paper's own scheme SIEM/SequentialPCA/MVG with its 10 x 30 = 300 numbers a sequence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.density import LowRankNormal
from emulator.flatten import SIEM
from emulator.reduce import SequentialPCA


@dataclass(frozen=True)
class PaperScheme:
    """SIEM/SequentialPCA/MVG: one Gaussian of the coefficients of aligned sequences, all workers pooled.

    Source: Chen, Park & Srivastava sec. 4.1-4.3; the Gaussian by its factor (eq. 7's covariance is singular).
    """

    flatten: SIEM
    reduce: SequentialPCA
    density: LowRankNormal

    @classmethod
    def fit(cls, aligned: np.ndarray, d1: int = 10, d2: int = 30) -> PaperScheme:
        """Fit to sequences (N, T, B, 3) on a common clock. Raises ValueError where they cannot span d1 x d2."""
        flatten = SIEM.fit(aligned)
        tangent = flatten.forward(aligned)
        reduce = SequentialPCA.fit(tangent, d1, d2)
        return cls(flatten, reduce, LowRankNormal.fit(reduce.forward(tangent), rho=0.0))

    def sample(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """n new sequences (n, T, B, 3) on the common clock."""
        return self.flatten.inverse(self.reduce.inverse(self.density.sample(n, rng)))

    def reconstruct(self, aligned: np.ndarray) -> np.ndarray:
        """Sequences (n, T, B, 3) as their coefficients give them back."""
        return self.flatten.inverse(self.reduce.inverse(self.reduce.forward(self.flatten.forward(aligned))))
