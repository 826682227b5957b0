"""Classical multidimensional scaling: points in the plane that lie about as far apart as sequences do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.judge.energy import pooled


@dataclass(frozen=True, eq=False)
class Mds:
    """Where the items lie.

    points    : (n, K) centred, K directions in falling order of their spread; in the unit of the distances
    explained : (K,) share of each direction in the sum of all positive eigenvalues
    negative  : share of the negative eigenvalues in the sum of all, by size; 0 for Euclidean distances
    """

    points: np.ndarray
    explained: np.ndarray
    negative: float


def mds(distances: np.ndarray, n_dims: int = 2) -> Mds:
    """Classical scaling of distances (n, n), symmetric, zero on the diagonal; signs fixed, so figures repeat.

    Raises ValueError for no square matrix, or for more directions than n.
    Source: Torgerson (1952); Chen, Park & Srivastava sec. 5.2, figure 15.
    """
    distances = np.asarray(distances, float)
    n = len(distances)
    if distances.shape != (n, n) or not np.allclose(distances, distances.T, rtol=1e-5, atol=1e-9):
        raise ValueError(f"mds: found {distances.shape}, expected symmetric distances (n, n)")
    if not 1 <= n_dims <= n:
        raise ValueError(f"mds: found {n_dims} directions, expected 1 to {n}")
    values, vectors = np.linalg.eigh(_doubly_centred(distances**2))
    positive = np.maximum(values[::-1], 0.0)
    points = vectors[:, ::-1][:, :n_dims] * np.sqrt(positive[:n_dims])
    total, size = positive.sum(), np.abs(values).sum()
    explained = positive[:n_dims] / total if total > 0 else np.zeros(n_dims)
    return Mds(_signed(points), explained, float(1.0 - total / size) if size > 0 else 0.0)


def mds_of_two(
    between: np.ndarray, among_a: np.ndarray, among_b: np.ndarray, n_dims: int = 2
) -> tuple[np.ndarray, np.ndarray, Mds]:
    """Two samples scaled together: points of a (n, K), of b (m, K), and the whole. Shapes as ``energy_u``."""
    whole = mds(pooled(between, among_a, among_b), n_dims)
    return whole.points[: len(among_a)], whole.points[len(among_a) :], whole


def _doubly_centred(squares: np.ndarray) -> np.ndarray:
    """Inner products (n, n) of points about their centre, from squared distances (n, n)."""
    by_row = squares.mean(axis=1, keepdims=True)
    centred = -0.5 * (squares - by_row - by_row.T + squares.mean())
    return (centred + centred.T) / 2


def _signed(points: np.ndarray) -> np.ndarray:
    """Directions turned so that the point farthest out on each lies on its positive side (first of equals)."""
    size = np.abs(points)
    farthest = np.argmax(size >= size.max(axis=0) * (1 - 1e-9), axis=0)
    return points * np.where(points[farthest, np.arange(points.shape[1])] < 0, -1.0, 1.0)
