"""The alignment matrix of LTSA: how far global coordinates are from an affine map of each neighbourhood's own ones.

It is banded where neighbours are near in time (bandwidth 2k), and sparse where they are not.
Source: spatio-temporal LTSA, table 1, steps 2 to 4. Its naive twin is in tests/naive.

The eigenvectors to the smallest eigenvalues of an alignment matrix, the constant one left out.

The constant vector is known to be in the null space; it is taken out by projection, and the rest found by Lanczos'
method on the inverse, (B + shift)^-1, from one banded or sparse factorisation: O(n) in the number of frames.

Neighbours of each frame: the nearest in space among those near in time, or the nearest of all.

Source: spatio-temporal LTSA, sec. 2.1. Of equal distances the earlier frame is the nearer.

Spatio-temporal local tangent space alignment (STLTSA): postures on a curve of few coordinates.

Neighbours are sought among the frames near in time, so that the alignment matrix is banded and the whole costs
O(k^2 n). Source: its sec. 2; plain LTSA (Zhang & Zha 2004) with ``neighbourhood="space"``.

Intrinsic dimension by the eigengap of the alignment matrix.

Source: spatio-temporal LTSA, sec. 2.3: the smallest d with |lambda_d - lambda_(d + 1)| > tau, without a word
on the scale. Here the matrix is built anew with d local coordinates for every d; lambda_d is the d-th eigenvalue above
the constant's zero, the largest of those that d coordinates use, and the gap is taken relative to the one after it:
(lambda_(d + 1) - lambda_d) / lambda_(d + 1), from 0 to 1 whatever n, k and the units are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

_AT_ONCE = 2**18
"""Numbers held at once while neighbourhoods are gone through."""


def tangents(points: np.ndarray, neighbours: np.ndarray, d: int) -> np.ndarray:
    """Local coordinates (n, k, d): the d leading eigenvectors of each neighbourhood's Gram matrix about its mean.

    points (n, m), neighbours (n, k); the leading one first.
    """
    n, k = neighbours.shape
    found = np.empty((n, k, d))
    for part in _parts(n, k * max(k, points.shape[1])):
        local = points[neighbours[part]]
        local -= local.mean(axis=1, keepdims=True)
        found[part] = np.linalg.eigh(local @ local.transpose(0, 2, 1))[1][:, :, : -d - 1 : -1]
    return found


def alignment_banded(neighbours: np.ndarray, local: np.ndarray) -> np.ndarray:
    """The alignment matrix in lower banded form: row j is the j-th diagonal below the main one, (width + 1, n).

    neighbours (n, k), increasing; local (n, k, d) as of ``tangents``.
    """
    n, k = neighbours.shape
    width = int(np.max(neighbours[:, -1] - neighbours[:, 0]))
    rows, columns = np.tril_indices(k)
    bands = np.zeros((n, width + 1))
    for part in _parts(n, k * k):
        low = neighbours[part][:, columns]
        first = int(neighbours[part].min())
        place = (low - first) * (width + 1) + neighbours[part][:, rows] - low
        added = np.bincount(place.ravel(), _complement(local[part])[:, rows, columns].ravel())
        stop = -(-len(added) // (width + 1))
        bands[first : first + stop].ravel()[: len(added)] += added
    return np.ascontiguousarray(bands.T)


def alignment_sparse(neighbours: np.ndarray, local: np.ndarray) -> Any:
    """The same matrix (n, n) as scipy's sparse columns."""
    from scipy.sparse import csc_array

    n, k = neighbours.shape
    row, column = np.repeat(neighbours, k, axis=1).ravel(), np.tile(neighbours, (1, k)).ravel()
    return csc_array((_complement(local).ravel(), (row, column)), shape=(n, n))


def _complement(local: np.ndarray) -> np.ndarray:
    """I - 1 1' / k - g g' of each neighbourhood, (b, k, k)."""
    k = local.shape[1]
    return np.eye(k) - 1.0 / k - local @ local.transpose(0, 2, 1)


def _parts(n: int, numbers_each: int) -> Iterator[slice]:
    block = max(1, _AT_ONCE // numbers_each)
    return (slice(start, min(start + block, n)) for start in range(0, n, block))


SHIFT = 1e-13
"""Of the largest diagonal entry; makes the matrix positive definite where it is singular up to rounding."""
SMALL = 120
"""Up to so many frames all eigenvectors are taken at once."""

Solve = Callable[[np.ndarray], np.ndarray]


def bottom_banded(bands: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """``count`` smallest eigenvalues (count,) above the constant's and their vectors (n, count), of a banded matrix."""
    from scipy.linalg import cho_solve_banded, cholesky_banded

    n = bands.shape[1]
    if n <= max(SMALL, 3 * (count + 1)):
        return _dense(_full(bands), count)
    factor = _factor(lambda shifted: cholesky_banded(shifted, lower=True), bands, bands[0].max())
    return _lanczos(lambda x: cho_solve_banded((factor, True), x), lambda x: _times(bands, x), n, count)


def bottom_sparse(matrix: Any, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The same of a sparse symmetric matrix."""
    from scipy.sparse import eye_array
    from scipy.sparse.linalg import splu

    n = matrix.shape[0]
    if n <= max(SMALL, 3 * (count + 1)):
        return _dense(matrix.toarray(), count)
    shifted = (matrix + SHIFT * matrix.diagonal().max() * eye_array(n)).tocsc()
    factor = splu(shifted, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return _lanczos(factor.solve, lambda x: matrix @ x, n, count)


def _factor(cholesky: Callable[[np.ndarray], np.ndarray], bands: np.ndarray, largest: float) -> np.ndarray:
    """The Cholesky factor with the least shift that is enough, from SHIFT upwards."""
    for power in range(6):
        shifted = bands.copy()
        shifted[0] += SHIFT * 10.0**power * largest
        try:
            return cholesky(shifted)
        except np.linalg.LinAlgError:
            continue
    raise ValueError("segmenting: the alignment matrix is not positive semidefinite; are all points finite?")


def _lanczos(solve: Solve, times: Solve, n: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    from scipy.sparse.linalg import LinearOperator, eigsh

    def inverse(x: np.ndarray) -> np.ndarray:
        found = solve(_centred(np.ravel(x)))
        return _centred(found)

    start = _centred(np.random.default_rng(0).normal(size=n))  # a fixed start: the same answer every time
    operator = LinearOperator((n, n), matvec=inverse, dtype=float)
    _, vectors = eigsh(operator, k=count, which="LA", v0=start, ncv=min(n - 1, 2 * count + 20))
    return _ordered(vectors, lambda x: times(x))


def _ordered(vectors: np.ndarray, times: Solve) -> tuple[np.ndarray, np.ndarray]:
    """Rayleigh's quotients and the vectors in their order: the inverse's own values have lost digits to the shift."""
    image = np.column_stack([times(column) for column in vectors.T])
    small = vectors.T @ image
    values, turn = np.linalg.eigh((small + small.T) / 2)
    return np.maximum(values, 0.0), vectors @ turn


def _dense(matrix: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """All at once; the constant is moved to the far end of the spectrum."""
    n = len(matrix)
    raised = matrix + np.full((n, n), 2.0 * np.trace(matrix) / n)
    values, vectors = np.linalg.eigh(raised)
    return np.maximum(values[:count], 0.0), vectors[:, :count]


def _full(bands: np.ndarray) -> np.ndarray:
    n = bands.shape[1]
    full = np.zeros((n, n))
    for lag, band in enumerate(bands[:n]):
        at = np.arange(n - lag)
        full[at + lag, at] = full[at, at + lag] = band[: n - lag]
    return full


def _times(bands: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The banded matrix times a vector."""
    found = bands[0] * x
    for lag in range(1, len(bands)):
        band = bands[lag, : len(x) - lag]
        found[lag:] += band * x[:-lag]
        found[:-lag] += band * x[lag:]
    return found


def _centred(x: np.ndarray) -> np.ndarray:
    return x - x.mean()


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
    _check_settings(points, k, d, neighbourhood)
    neighbours = NEIGHBOURHOODS[neighbourhood](points, k)
    values, vectors = bottom(neighbours, tangents(points, neighbours, d), max(d, n_values), neighbourhood)
    return Embedding(signed(vectors[:, :d]), values, neighbours, points)


def bottom(neighbours: np.ndarray, local: np.ndarray, count: int, neighbourhood: str) -> tuple[np.ndarray, np.ndarray]:
    """The ``count`` smallest eigenvalues of the alignment matrix above the constant's, and their vectors (n, count)."""
    count = min(count, len(neighbours) - 2)
    if neighbourhood == "time":
        return bottom_banded(alignment_banded(neighbours, local), count)
    return bottom_sparse(alignment_sparse(neighbours, local), count)


def _check_settings(points: np.ndarray, k: int, d: int, neighbourhood: str) -> None:
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


TAU = 0.95
MOST = 7
"""Dimensions that are looked at."""


def dimension(points: np.ndarray, k: int, tau: float = TAU, *, neighbourhood: str = "time") -> tuple[int, np.ndarray]:
    """The smallest dimension whose relative eigengap is above ``tau``, that of the widest gap where none is; the gaps.

    points : (n, m), k neighbours of each; at most MOST dimensions, and fewer than k and than m are looked at
    """
    points = np.asarray(points, float)
    most = max(1, min(MOST, k - 1, len(points) - 4, points.shape[1]))
    neighbours = NEIGHBOURHOODS[neighbourhood](points, k)
    local = tangents(points, neighbours, most)
    gaps = np.array([_gap(bottom(neighbours, local[:, :, :d], d + 1, neighbourhood)[0], d) for d in range(1, most + 1)])
    wide = np.flatnonzero(gaps > tau)
    return int(wide[0] if len(wide) else gaps.argmax()) + 1, gaps


def _gap(values: np.ndarray, d: int) -> float:
    return float((values[d] - values[d - 1]) / max(float(values[d]), 1e-300))
