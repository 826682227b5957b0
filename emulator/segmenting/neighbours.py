"""Neighbours of each frame: the nearest in space among those near in time, or the nearest of all.

Source: spatio-temporal LTSA (seed 003), sec. 2.1. Of equal distances the earlier frame is the nearer.
"""

from __future__ import annotations

import numpy as np


def temporal_neighbours(points: np.ndarray, k: int) -> np.ndarray:
    """Among the frames i - k to i + k, the k nearest in space to each frame i, without itself: (n, k), increasing.

    points : (n, m)
    The cost is O(k n m + k n log k). Raises ValueError unless 1 <= k < n.
    """
    _check(points, k)
    n = len(points)
    square = np.full((n, 2 * k), np.inf)  # columns: i - k .. i - 1, i + 1 .. i + k
    for lag in range(1, k + 1):
        step = points[lag:] - points[:-lag]
        apart = np.einsum("tm,tm->t", step, step)
        square[:-lag, k + lag - 1] = apart
        square[lag:, k - lag] = apart
    nearest = np.sort(np.argsort(square, axis=1, kind="stable")[:, :k], axis=1)
    return np.arange(n)[:, None] + nearest - k + (nearest >= k)


def spatial_neighbours(points: np.ndarray, k: int) -> np.ndarray:
    """The k nearest of all points to each, without itself: (n, k), increasing; as plain LTSA takes them, in O(n^2).

    Raises ValueError unless 1 <= k < n.
    """
    _check(points, k)
    from scipy.spatial import cKDTree

    n = len(points)
    found = cKDTree(points).query(points, k + 1)[1]
    own = found == np.arange(n)[:, None]
    own[~own.any(axis=1), -1] = True  # of coinciding points the tree may leave the point itself out
    return np.sort(found[~own].reshape(n, k), axis=1)


def _check(points: np.ndarray, k: int) -> None:
    if not 1 <= k < len(points):
        raise ValueError(f"neighbours: found k = {k} of {len(points)} frames, expected 1 to {len(points) - 1}")
