"""The covariates of the training people as one Gaussian: what an unknown one is expected to be, given the known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ROUNDS, SETTLED = 50, 1e-4


@dataclass(frozen=True, eq=False)
class CovariateGaussian:
    """mean (V,) and covariance (V, V) of the covariates."""

    mean: np.ndarray
    covariance: np.ndarray

    @classmethod
    def fit(cls, rows: np.ndarray, n_people: int) -> CovariateGaussian:
        """From rows (R, V) of ``n_people``, NaN where unknown; each covariate known at least twice and varying.

        The EM algorithm for a normal sample with gaps; correlations are shrunk by 1.2 / n_people, at most 0.3, so that
        three people do not tie five covariates to each other. Source: Little & Rubin, Statistical Analysis with Missing
        Data, sec. 11.2.
        """
        centre, spread = np.nanmean(rows, axis=0), np.nanstd(rows, axis=0)
        scaled = (rows - centre) / spread
        patterns, rho = list(zip(*np.unique(np.isnan(scaled), axis=0, return_counts=True))), min(0.3, 1.2 / n_people)
        guess = cls(np.zeros(rows.shape[1]), np.eye(rows.shape[1]))
        for _ in range(ROUNDS if len(patterns) > 1 or patterns[0][0].any() else 1):
            filled = guess.filled(scaled)
            unsure = sum((n * guess.unsure(gap) for gap, n in patterns), np.zeros_like(guess.covariance))
            mean = filled.mean(axis=0)
            covariance = ((filled - mean).T @ (filled - mean) + unsure) / len(rows)
            before, guess = guess, cls(mean, covariance * (1 - rho) + rho * np.diag(np.diag(covariance)))
            if np.abs(guess.covariance - before.covariance).max(initial=0.0) < SETTLED:
                break
        return cls(centre + spread * guess.mean, guess.covariance * np.outer(spread, spread))

    def filled(self, rows: np.ndarray) -> np.ndarray:
        """Rows (R, V) with NaN replaced by the conditional mean given what the row knows."""
        out, gaps = rows.copy(), np.isnan(rows)
        for gap in np.unique(gaps[gaps.any(axis=1)], axis=0):
            at = np.flatnonzero(np.all(gaps == gap, axis=1))
            out[np.ix_(at, gap)] = self.mean[gap] + (rows[np.ix_(at, ~gap)] - self.mean[~gap]) @ self._slope(gap).T
        return out

    def unsure(self, gap: np.ndarray) -> np.ndarray:
        """(V, V) conditional covariance of the covariates in ``gap`` (V,) given the others, 0 elsewhere."""
        left = np.zeros_like(self.covariance)
        if gap.any():
            inner = np.ix_(gap, gap)
            left[inner] = self.covariance[inner] - self._slope(gap) @ self.covariance[np.ix_(~gap, gap)]
        return left

    def _slope(self, gap: np.ndarray) -> np.ndarray:
        """Regression (gaps, known) of the unknown on the known."""
        known = self.covariance[np.ix_(~gap, ~gap)]
        return np.asarray(np.linalg.lstsq(known, self.covariance[np.ix_(~gap, gap)], rcond=1e-10)[0].T)
