"""A smoothed bootstrap that keeps mean and covariance: training rows, blurred by a share of their covariance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.density import LowRankNormal

QUARTILES = (0.25, 0.5, 0.75)
N_TRIED, N_HALVINGS = 400, 20


@dataclass(frozen=True)
class KernelDensity:
    """x = mean + sqrt(1 - share) (a training row - mean), scaled to their covariance, + sqrt(share) noise.

    rows  : (N, K) training coefficients, so scaled that draws have their covariance whatever the share
    noise : the training covariance about 0; share : in [0, 1]; 0 copies, 1 is the MVG
    Source: Silverman & Young (1987); the share by distances to what is left out, see ``fit``.
    """

    mean: np.ndarray
    rows: np.ndarray
    noise: LowRankNormal
    share: float

    @classmethod
    def fit(cls, coefficients: np.ndarray, share: float | None = None) -> KernelDensity:
        """Fit to (N, K), N >= 3; without ``share`` the largest with draws no further from the training than it should.

        No further: the quartiles of the distance from a draw to the nearest row, against those from a row to the
        nearest other one, in the geometric mean. That is what an unseen sequence would be.
        """
        if len(coefficients) < 3:
            raise ValueError(f"a kernel density needs at least 3 sequences, found {len(coefficients)}")
        whole = LowRankNormal.fit(coefficients, rho=0.0)
        noise = LowRankNormal(np.zeros(len(whole.mean)), whole.factor, whole.spread, 0.0)
        rows = (coefficients - whole.mean) * np.sqrt(len(coefficients) / (len(coefficients) - 1))
        return cls(whole.mean, rows, noise, _share(coefficients, whole.mean, rows, noise) if share is None else share)

    def sample(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """n draws (n, K); first the rows, then the noise."""
        at = rng.integers(len(self.rows), size=n)
        return np.asarray(self._at(self.share, at, self.noise.sample(n, rng)))

    def _at(self, share: float, at: np.ndarray, noise: np.ndarray) -> np.ndarray:
        return self.mean + np.sqrt(1.0 - share) * self.rows[at] + np.sqrt(share) * noise

    def log_likelihood(self, coefficients: np.ndarray) -> np.ndarray:
        """Log density (...,) of coefficients (..., K) in the span of the training; -inf beside the rows at share 0."""
        _, size, basis = np.linalg.svd(self.noise.factor, full_matrices=False)
        kept = size > size.max(initial=0.0) * 1e-5
        if self.share == 0:
            return np.full(coefficients.shape[:-1], -np.inf)
        white = (basis[kept] / size[kept, None]).T
        x = (coefficients - self.mean) @ white / np.sqrt(self.share)
        rows = np.sqrt((1.0 - self.share) / self.share) * self.rows @ white
        square = np.sum(x**2, -1)[..., None] + np.sum(rows**2, -1) - 2 * x @ rows.T
        log_volume = 0.5 * kept.sum() * np.log(2 * np.pi * self.share) + np.log(size[kept]).sum()
        nearest = square.min(axis=-1)
        mixed = np.log(np.mean(np.exp(-0.5 * (square - nearest[..., None])), axis=-1))
        return np.asarray(mixed - 0.5 * nearest - log_volume)


def _share(coefficients: np.ndarray, mean: np.ndarray, rows: np.ndarray, noise: LowRankNormal) -> float:
    """By bisection, always with the same random numbers."""
    rng = np.random.default_rng(0)
    at, drawn = np.arange(N_TRIED) % len(rows), noise.sample(N_TRIED, rng)
    asked = _quartiles(_squares(coefficients, coefficients) + np.diag(np.full(len(rows), np.inf)))
    tried, low, high = KernelDensity(mean, rows, noise, 0.0), 0.0, 1.0
    for _ in range(N_HALVINGS):
        middle = (low + high) / 2
        reached = _quartiles(_squares(tried._at(middle, at, drawn), coefficients))
        low, high = (low, middle) if np.mean(reached - asked) > 0 else (middle, high)
    return high if high == 1.0 else low


def _squares(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.sum(a**2, -1)[:, None] + np.sum(b**2, -1) - 2 * a @ b.T


def _quartiles(square: np.ndarray) -> np.ndarray:
    """(3,) logarithms of the quartiles of the distance to the nearest."""
    return np.asarray(np.log(np.maximum(np.quantile(np.sqrt(np.maximum(square.min(axis=1), 0.0)), QUARTILES), 1e-12)))
