"""Intrinsic dimension by the eigengap of the alignment matrix.

Source: spatio-temporal LTSA (seed 003), sec. 2.3: the smallest d with |lambda_d - lambda_(d + 1)| > tau, without a word
on the scale. Here the matrix is built anew with d local coordinates for every d; lambda_d is the d-th eigenvalue above
the constant's zero, the largest of those that d coordinates use, and the gap is taken relative to the one after it:
(lambda_(d + 1) - lambda_d) / lambda_(d + 1), from 0 to 1 whatever n, k and the units are.
"""

from __future__ import annotations

import numpy as np

from emulator.segmenting.alignment import tangents
from emulator.segmenting.stltsa import NEIGHBOURHOODS, bottom

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
