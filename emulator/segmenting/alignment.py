"""The alignment matrix of LTSA: how far global coordinates are from an affine map of each neighbourhood's own ones.

It is banded where neighbours are near in time (bandwidth 2k), and sparse where they are not.
Source: spatio-temporal LTSA (seed 003), table 1, steps 2 to 4. Its naive twin is in tests/naive.py.
"""

from __future__ import annotations

from collections.abc import Iterator
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
