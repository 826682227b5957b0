"""Sums of arcs between many pairs of long rows of unit vectors. Its twins: judge.distance.distances_numpy, tests."""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled

# asin(sqrt(z)) / sqrt(z) on [0, 1/2] to 1.3e-7 (Chebyshev, degree 6)
_C0, _C1, _C2, _C3, _C4, _C5, _C6 = (
    np.float32(c)
    for c in (1.0000000804, 0.1666509779, 0.0754907417, 0.0390137922, 0.0601242776, -0.0535424837, 0.0999071056)
)
_ZERO, _QUARTER, _ONE, _RIGHT = (np.float32(c) for c in (0.0, 0.25, 1.0, np.pi / 2))
_ROWS, _POINTS = 16, 1024


# NOTE: fastmath lets the sum over the points run in lanes; no infinity or NaN comes in (the caller checks).
@compiled(fastmath=True, error_model="numpy", nogil=True)
def _half_arcs(x0, x1, x2, y0, y1, y2):
    """Half of the summed arcs between the unit vectors (x0, x1, x2) and (y0, y1, y2), float32 (P,) each.

    By half the chord, so that small arcs keep their digits: sin(arc / 2) = |x - y| / 2, beyond a right angle by the
    complement, which leaves one square root a pair.
    """
    total = _ZERO
    for k in range(x0.size):
        across, along, up = x0[k] - y0[k], x1[k] - y1[k], x2[k] - y2[k]
        square = _QUARTER * (across * across + along * along + up * up)
        rest = abs(_ONE - square)
        z = square if square < rest else rest
        p = _C5 + z * _C6
        p = _C4 + z * p
        p = _C3 + z * p
        p = _C2 + z * p
        p = _C1 + z * p
        p = _C0 + z * p
        r = np.sqrt(z) * p
        total += r if square < rest else _RIGHT - r
    return total


@compiled(nogil=True)
def add_arcs(a, b, first, last, symmetric, out):
    """Add to out (n, m) the summed arcs between rows first:last of a (n, 3, P) and rows of b (m, 3, P), float32.

    symmetric : a is b, and only columns right of the diagonal are filled
    In blocks: ``_ROWS`` rows of a over ``_POINTS`` points stay in the cache while the rows of b pass by.
    """
    points = a.shape[2]
    for low in range(first, last, _ROWS):
        high = min(low + _ROWS, last)
        for start in range(0, points, _POINTS):
            end = min(start + _POINTS, points)
            for j in range(low + 1 if symmetric else 0, b.shape[0]):
                y0, y1, y2 = b[j, 0, start:end], b[j, 1, start:end], b[j, 2, start:end]
                for i in range(low, min(high, j) if symmetric else high):
                    x0, x1, x2 = a[i, 0, start:end], a[i, 1, start:end], a[i, 2, start:end]
                    out[i, j] += 2.0 * _half_arcs(x0, x1, x2, y0, y1, y2)
