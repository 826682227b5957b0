"""The law of the joint coordinates z of one worker, or of the population: a mixture of Gaussians of low rank."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from emulator.density import LowRankNormal


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
            z *= self.reach[at, None]  # NOTE: in place; a new array of all draws costs as much as drawing them
        z += self._centres[at]
        if self.people is not None:
            drawn = self.people.sample(n, rng)
            z += drawn if self.size is None else self.people.mean + self.size[at, None] * (drawn - self.people.mean)
        return z if given is None else self._moved(z, at, *given)

    @cached_property
    def _edges(self) -> np.ndarray:
        """(M,) running sums of the weights."""
        return np.cumsum(self.weight)

    @cached_property
    def _centres(self) -> np.ndarray:
        """(M, K) where the components lie; people bring their own centre."""
        return self.mean if self.people is not None else self.mean + self.centre

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
    return np.minimum(np.searchsorted(edges, u * edges[-1], side="right"), len(edges) - 1)
