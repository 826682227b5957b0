"""Marks (sub-task ends) on the common clock, as unbounded coordinates that keep them in order and inside (0, 1)."""

from __future__ import annotations

import numpy as np

SMALLEST_GAP = 1e-3


def clock_to_coordinates(mark_clock: np.ndarray) -> np.ndarray:
    """Additive log ratios of the gaps between marks: (N, E) in (0, 1), increasing -> (N, E).

    Gaps below 1e-3 of the performance are raised to it, since a mark on the very start or end has no log ratio.
    Source: Aitchison's additive log ratio; the last gap (last mark to the end) is the divisor.
    """
    n = len(mark_clock)
    edges = np.concatenate([np.zeros((n, 1)), mark_clock, np.ones((n, 1))], axis=1)
    gaps = np.maximum(np.diff(edges, axis=1), SMALLEST_GAP)
    return np.log(gaps[:, :-1] / gaps[:, -1:])


def coordinates_to_clock(coordinates: np.ndarray) -> np.ndarray:
    """The way back: (N, E) -> (N, E), increasing along E and strictly inside (0, 1)."""
    edges = np.ones((len(coordinates), coordinates.shape[1] + 1))
    np.exp(np.minimum(np.maximum(coordinates, -12.0), 12.0), out=edges[:, :-1])  # beyond, a gap is lost to rounding
    for e in range(1, edges.shape[1]):  # running sums of the gaps: a few columns are quicker one by one
        edges[:, e] += edges[:, e - 1]
    return np.asarray(edges[:, :-1] / edges[:, -1:])
