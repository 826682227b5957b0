"""PWI: at each time a Gaussian in the tangent space of that time's mean posture."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.density import LowRankNormal


@dataclass(frozen=True)
class Pointwise:
    """Tangent coordinates at time t are mean_t + z_t rows_t, with z_t (N,) standard normal.

    mean : (T, C); rows : (N, T, C) training deviations over sqrt(N - 1), so that rows_t' rows_t is the covariance
    shared : one z for all times, which makes draws as smooth as the training; else one for each, as in the paper
    Source: Chen, Park & Srivastava sec. 4.3.3, eq. 6 (which divides by N).
    """

    mean: np.ndarray
    rows: np.ndarray
    shared: bool

    @classmethod
    def fit(cls, coordinates: np.ndarray, shared: bool) -> Pointwise:
        """Fit to coordinates (N, T, C) at the moving mean."""
        mean = coordinates.mean(axis=0)
        return cls(mean, (coordinates - mean) / np.sqrt(len(coordinates) - 1), shared)

    def sample(
        self, n: int, rng: np.random.Generator, *, allow_unstable: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """n coordinates (n, T, C), and no start (n, 0)."""
        n_rows, n_times = self.rows.shape[:2]
        if self.shared:
            drawn = np.tensordot(rng.standard_normal((n, n_rows)), self.rows, 1)
        else:
            drawn = np.swapaxes(rng.standard_normal((n_times, n, n_rows)) @ np.swapaxes(self.rows, 0, 1), 0, 1)
        return self.mean + drawn, np.zeros((n, 0))

    def log_likelihood(self, coordinates: np.ndarray, start: np.ndarray) -> np.ndarray:
        """Log density (...,) of coordinates (..., T, C) in the subspace of the training: at each time, or of all."""
        flat = (*coordinates.shape[:-2], -1)
        if self.shared:
            whole = LowRankNormal.of_rows(self.mean.ravel(), self.rows.reshape(len(self.rows), -1), 0.0)
            return whole.log_likelihood(coordinates.reshape(flat))
        values, vectors = np.linalg.eigh(np.einsum("ntc,ntd->tcd", self.rows, self.rows, optimize=True))
        kept = values > values[:, -1:] * 1e-10
        inside = np.einsum("...tc,tcd->...td", coordinates - self.mean, vectors)
        terms = np.where(
            kept, inside**2 / np.where(kept, values, 1.0) + np.log(2 * np.pi * np.where(kept, values, 1)), 0
        )
        return np.asarray(-0.5 * terms.sum(axis=(-1, -2)))
