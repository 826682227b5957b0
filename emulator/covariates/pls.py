"""Partial least squares of one score at a time (PLS1), on standardised covariates, for many scores and folds at once.

Written here and not taken from scikit-learn: that would be a heavy dependency of every run for thirty lines, and its
one fit at a time is far too slow for a leave-one-out of every score. Its numbers are the test.
"""

from __future__ import annotations

import numpy as np

NOTHING = 1e-10
"""Share of a score's covariance with the covariates below which no further component is looked for."""


def slopes_of_products(gram: np.ndarray, cross: np.ndarray, n_components: int) -> np.ndarray:
    """Slopes on X with 0, 1, ... components, (A + 1, ..., P, K), from the products X'X (..., P, P) and X'y (..., P, K).

    Each column of ``cross`` is a score of its own. X and y are centred; X is scaled by whoever makes the products.
    A score that nothing more is to be said of keeps its slopes.
    Source: NIPALS for one response (Wold 1975; Geladi & Kowalski 1986) written in the products, as Dayal & MacGregor
    (1997), "Improved PLS algorithms", algorithm 1: X'y is deflated, X is not touched.
    """
    left, slope = cross, np.zeros_like(cross)
    least = NOTHING * np.sqrt(_inner(cross, cross))
    found: list[np.ndarray] = [slope]
    weights: list[np.ndarray] = []
    loadings: list[np.ndarray] = []
    for _ in range(n_components):
        size = np.sqrt(_inner(left, left))
        weight = left * np.where(size > least, 1.0 / np.where(size > least, size, 1.0), 0.0)
        rotated = weight
        for before, load in zip(weights, loadings):
            rotated = rotated - _inner(load, weight) * before
        image = gram @ rotated
        square = _inner(rotated, image)
        load = image * np.where(square > 0, 1.0 / np.where(square > 0, square, 1.0), 0.0)
        told = _inner(rotated, left)
        slope = slope + rotated * np.where(square > 0, told / np.where(square > 0, square, 1.0), 0.0)
        left = left - load * told
        weights.append(rotated)
        loadings.append(load)
        found.append(slope)
    return np.stack(found)


def _inner(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.einsum("...pk,...pk->...k", one, other)[..., None, :]


def pls1(x: np.ndarray, y: np.ndarray, n_components: int) -> tuple[np.ndarray, np.ndarray]:
    """Intercepts (A + 1, K) and slopes (A + 1, P, K) of y (N, K) on x (N, P) with 0, 1, ... components.

    A covariate that does not vary gets slope 0. Raises ValueError for fewer than two rows.
    """
    if len(x) < 2:
        raise ValueError(f"partial least squares: found {len(x)} rows, expected 2 or more")
    centre, middle = x.mean(axis=0), y.mean(axis=0)
    spread = spread_of(np.mean((x - centre) ** 2, axis=0), 1e-20 * np.mean(x**2, axis=0))
    scaled = (x - centre) / spread
    slopes = slopes_of_products(scaled.T @ scaled, scaled.T @ (y - middle), n_components) / spread[:, None]
    return middle - np.einsum("p,apk->ak", centre, slopes), slopes


def spread_of(variance: np.ndarray, rounding: np.ndarray) -> np.ndarray:
    """Standard deviations; infinite where the variance is only rounding: no slope then."""
    return np.where(variance > rounding, np.sqrt(np.maximum(variance, 1e-300)), np.inf)
