"""The multivariate Gaussian (MVG) of few sequences and many coefficients, held by its factor, never by its inverse.

The law of the joint coordinates z of one worker, or of the population: a mixture of Gaussians of low rank.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import sqrt

import numpy as np


@dataclass(frozen=True)
class LowRankNormal:
    """x = mean + sqrt(1 - rho) factor' xi + sqrt(rho) spread * eta, with xi (R,) and eta (K,) standard normal.

    mean   : (K,)
    factor : (R, K); factor' factor is the covariance of the training scores, of rank at most R
    spread : (K,) standard deviations, those of the factor, so that rho moves correlations and no variance
    rho    : share given to independent coefficients, in [0, 1]
    No Cholesky: with fewer sequences than coefficients the covariance is singular and its factor is the data itself.
    Source: Chen, Park & Srivastava sec. 4.3.1 (MVG; rho = 1 is IG), with rho as named shrinkage of correlations.
    """

    mean: np.ndarray
    factor: np.ndarray
    spread: np.ndarray
    rho: float

    @classmethod
    def fit(cls, scores: np.ndarray, rho: float = 0.1) -> LowRankNormal:
        """Mean and covariance of scores (N, K), N >= 2."""
        if len(scores) < 2:
            raise ValueError(f"a Gaussian needs at least 2 sequences, found {len(scores)}")
        mean = scores.mean(axis=0)
        return cls.of_rows(mean, (scores - mean) / np.sqrt(len(scores) - 1), rho)

    @classmethod
    def of_rows(cls, mean: np.ndarray, rows: np.ndarray, rho: float) -> LowRankNormal:
        """The Gaussian with covariance rows' rows (N, K), its factor compressed to min(N, K) rows."""
        if not 0 <= rho <= 1:
            raise ValueError(f"rho: found {rho}, expected a share from 0 to 1")
        return cls(mean, compressed(rows), np.linalg.norm(rows, axis=0), float(rho))

    @property
    def n_draws(self) -> int:
        """Standard normal numbers that one item takes."""
        return len(self.factor) + len(self.mean)

    @property
    def covariance(self) -> np.ndarray:
        """(K, K)."""
        return (1 - self.rho) * self.factor.T @ self.factor + self.rho * np.diag(self.spread**2)

    def covariance_with(self, index: int) -> np.ndarray:
        """(K,) covariance of every coefficient with coefficient ``index``."""
        column = (1 - self.rho) * self.factor.T @ self.factor[:, index]
        column[index] += self.rho * self.spread[index] ** 2
        return column

    def sample(self, n: int, rng: np.random.Generator) -> np.ndarray:
        """n draws (n, K); first xi (n, R), then eta (n, K); no eta where rho is 0."""
        xi = rng.standard_normal((n, len(self.factor)))
        if self.rho == 0:
            z = xi @ self.factor
            z += self.mean
            return z
        eta = rng.standard_normal((n, len(self.mean)))
        return self.mean + sqrt(1 - self.rho) * (xi @ self.factor) + sqrt(self.rho) * self.spread * eta

    def of(self, xi: np.ndarray, rng: np.random.Generator) -> np.ndarray:
        """One item (K,) from given numbers xi (R,); only what rho leaves independent is drawn."""
        x = self.mean + sqrt(1 - self.rho) * (xi @ self.factor)
        return x if self.rho == 0 else x + sqrt(self.rho) * self.spread * rng.standard_normal(len(self.mean))

    def log_likelihood(self, scores: np.ndarray) -> np.ndarray:
        """Log density (...,) of scores (..., K) in the subspace where this Gaussian lives.

        That subspace is the span of the covariance: all K where rho > 0, the rows of the factor where rho = 0.
        Source: Chen, Park & Srivastava eq. 7, with its sign slip mended and the singular directions left out.
        """
        if self.rho == 0:  # by the factor itself, since K x K may be far larger
            _, size, rows = np.linalg.svd(self.factor, full_matrices=False)
            values, vectors = size**2, rows.T
        else:
            values, vectors = np.linalg.eigh(self.covariance)
        kept = values > values.max(initial=0.0) * 1e-10
        coordinates = (scores - self.mean) @ vectors[:, kept]
        quadratic = np.sum(coordinates**2 / values[kept], axis=-1)
        return -0.5 * (quadratic + np.sum(np.log(2 * np.pi * values[kept])))


def regression(column: np.ndarray, at: int) -> np.ndarray:
    """(K,) slopes of all coefficients on coefficient ``at``, 1 for itself, from its covariances ``column`` (K,)."""
    slope = column / column[at] if column[at] > 1e-12 else np.zeros_like(column)
    slope[at] = 1.0
    return slope


def compressed(rows: np.ndarray) -> np.ndarray:
    """A factor (R, K) with the same rows' rows and R the numerical rank, at most min(N, K)."""
    _, values, vectors = np.linalg.svd(rows, full_matrices=False)
    kept = values > (values[0] * 1e-10 if len(values) and values[0] > 0 else np.inf)
    vectors = vectors[kept]
    if len(vectors):
        largest = np.take_along_axis(vectors, np.abs(vectors).argmax(axis=1)[:, None], axis=1)
        vectors = vectors * np.where(largest < 0, -1.0, 1.0)
    return values[kept][:, None] * vectors


@dataclass(frozen=True, eq=False)
class Law:
    """z = centre + mean of one of M components + its reach * noise, and people in place of the centre.

    weight : (M,) adds to 1; mean : (M, K); reach : (M,) factor on the noise; centre : (K,)
    noise  : what varies about a component, mean 0; people : how workers differ, or None for one worker
    size   : (M,) factor on how workers differ about people's mean; None: 1
    One component is the plain Gaussian (MVG of Chen, Park & Srivastava sec. 4.3.1).
    """

    weight: np.ndarray
    mean: np.ndarray
    reach: np.ndarray
    noise: LowRankNormal
    centre: np.ndarray
    people: LowRankNormal | None = None
    size: np.ndarray | None = None

    def sample(self, n: int, rng: np.random.Generator, given: tuple[int, np.ndarray] | None = None) -> np.ndarray:
        """n draws (n, K): first the component (if there are several), then the noise, then the people.

        given : (coordinate, its values (n,)): draws from the conditional law, by Bayes' rule for the component and
                Matheron's rule (noise kept, moved along the regression) within it.
        """
        if len(self.weight) == 1:
            at, z = np.zeros(n, int), self.noise.sample(n, rng) * self.reach
        else:
            u = rng.random(n)
            z = self.noise.sample(n, rng)
            at = placed(self._edges, u) if given is None else chosen(self.weight_given(*given), u)
            z *= self.reach.take(at)[:, None]  # NOTE: in place; a new array of all draws costs as much as drawing them
        z += self._about.take(at, axis=0)
        if self.people is not None:
            drawn = self.people.sample(n, rng)
            z += drawn if self.size is None else self.people.mean + self.size[at, None] * (drawn - self.people.mean)
        return z if given is None else self._moved(z, at, *given)

    @cached_property
    def _about(self) -> np.ndarray:
        """(M, K) what the noise lies about in each component; people bring their own centre."""
        return self.mean if self.people is not None else self.mean + self.centre

    @cached_property
    def _edges(self) -> np.ndarray:
        """(M,) running sums of the weights."""
        return np.cumsum(self.weight)

    def weight_given(self, coordinate: int, value: np.ndarray) -> np.ndarray:
        """(n, M) weights of the components once a coordinate of z is known to be ``value`` (n,)."""
        mean, covariance = self.coordinates(np.array([coordinate]))
        variance = np.maximum(covariance[:, 0, 0], 1e-12)
        square = (value[:, None] - mean[:, 0]) ** 2 / variance
        log_weight = np.log(self.weight) - 0.5 * (square + np.log(variance))
        likely = np.exp(log_weight - log_weight.max(axis=1, keepdims=True))
        return np.asarray(likely / likely.sum(axis=1, keepdims=True))

    def covariance_with(self, coordinate: int) -> np.ndarray:
        """(M, K) covariance of z with one coordinate within each component."""
        column = self.reach[:, None] ** 2 * self.noise.covariance_with(coordinate)
        if self.people is None:
            return column
        size = np.ones(1) if self.size is None else self.size
        return column + size[:, None] ** 2 * self.people.covariance_with(coordinate)

    def coordinates(self, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Means (M, A) and covariances (M, A, A) of the coordinates ``at`` (A,) in each component."""
        mean = self.mean[:, at] + (self.centre if self.people is None else self.people.mean)[at]
        return mean, np.stack([self.covariance_with(int(i))[:, at] for i in at], axis=1)

    def _moved(self, z: np.ndarray, component: np.ndarray, coordinate: int, value: np.ndarray) -> np.ndarray:
        column = self.covariance_with(coordinate)
        own = column[:, coordinate : coordinate + 1]
        slope = np.where(own > 0, column / np.where(own > 0, own, 1.0), 0.0)
        slope[:, coordinate] = 1.0
        return np.asarray(z + (value - z[:, coordinate])[:, None] * slope[component])


def chosen(weight: np.ndarray, u: np.ndarray) -> np.ndarray:
    """The components (n,) that uniform numbers u (n,) fall on, each with a row of its own of ``weight`` (n, M)."""
    edges = np.cumsum(weight, axis=-1)
    return np.minimum((edges <= u[:, None] * edges[:, -1:]).sum(axis=1), weight.shape[1] - 1)


def placed(edges: np.ndarray, u: np.ndarray) -> np.ndarray:
    """The components (n,) that uniform numbers u (n,) fall on, by the running sums (M,) of their weights."""
    return np.minimum(edges.searchsorted(u * edges[-1], side="right"), len(edges) - 1)
