"""Spatio-temporal local tangent space alignment (STLTSA): postures on a curve of few coordinates.

Neighbours are sought among the frames near in time, so that the alignment matrix is banded and the whole costs
O(k^2 n). Source: seed 003, sec. 2; plain LTSA (Zhang & Zha 2004) with ``neighbourhood="space"``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.segmenting.alignment import alignment_banded, alignment_sparse, tangents
from emulator.segmenting.bottom import bottom_banded, bottom_sparse
from emulator.segmenting.neighbours import spatial_neighbours, temporal_neighbours

NEIGHBOURHOODS = {"time": temporal_neighbours, "space": spatial_neighbours}


@dataclass(frozen=True, eq=False)
class Embedding:
    """Global coordinates of n frames.

    coordinates : (n, d), each of mean 0 and length 1, uncorrelated; the largest entry of each is positive
    eigenvalues : of the alignment matrix, increasing, from the second smallest on; at least d
    neighbours  : (n, k) frames
    points      : (n, m) what was embedded
    """

    coordinates: np.ndarray
    eigenvalues: np.ndarray
    neighbours: np.ndarray
    points: np.ndarray

    @property
    def d(self) -> int:
        return self.coordinates.shape[1]

    @property
    def k(self) -> int:
        return self.neighbours.shape[1]


def stltsa(points: np.ndarray, k: int, d: int = 2, *, neighbourhood: str = "time", n_values: int = 0) -> Embedding:
    """Embed n points (n, m) of a movement, in the order of time, in d dimensions, by k neighbours of each.

    neighbourhood : "time", the k nearest among the 2k frames around; "space", the k nearest of all
    n_values      : eigenvalues wanted, where more than d
    Raises ValueError for what is no number, for k outside d + 1 .. n - 1, and for a body that does not move.
    """
    points = np.asarray(points, float)
    _check(points, k, d, neighbourhood)
    neighbours = NEIGHBOURHOODS[neighbourhood](points, k)
    values, vectors = bottom(neighbours, tangents(points, neighbours, d), max(d, n_values), neighbourhood)
    return Embedding(signed(vectors[:, :d]), values, neighbours, points)


def bottom(neighbours: np.ndarray, local: np.ndarray, count: int, neighbourhood: str) -> tuple[np.ndarray, np.ndarray]:
    """The ``count`` smallest eigenvalues of the alignment matrix above the constant's, and their vectors (n, count)."""
    count = min(count, len(neighbours) - 2)
    if neighbourhood == "time":
        return bottom_banded(alignment_banded(neighbours, local), count)
    return bottom_sparse(alignment_sparse(neighbours, local), count)


def _check(points: np.ndarray, k: int, d: int, neighbourhood: str) -> None:
    n = len(points)
    if neighbourhood not in NEIGHBOURHOODS:
        raise ValueError(f"neighbourhood: found {neighbourhood!r}, expected {' or '.join(NEIGHBOURHOODS)}")
    if not np.all(np.isfinite(points)):
        frame = int(np.argwhere(~np.isfinite(points))[0, 0])
        raise ValueError(f"frame {frame} has a gap: clean the recording first")
    if d < 1 or n < d + 3:
        raise ValueError(f"found {n} frames, expected {max(d, 1) + 3} or more for {d} dimensions")
    if not d < k < n:
        raise ValueError(f"found k = {k} neighbours, expected {d + 1} to {n - 1} for {d} dimensions of {n} frames")
    if not np.ptp(points, axis=0).max() > 0:
        raise ValueError("nothing moves: all frames are the same")


def signed(vectors: np.ndarray) -> np.ndarray:
    """The vectors with the sign at which the entry of largest size is positive (the first where some are as large)."""
    size = np.abs(vectors)
    first = np.argmax(size > size.max(axis=0) * (1 - 1e-6), axis=0)
    return vectors * np.where(vectors[first, np.arange(vectors.shape[1])] < 0, -1.0, 1.0)
