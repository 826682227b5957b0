"""Sums of arcs between many pairs of long rows of unit vectors. Its twins: judge.distance.distances_numpy, tests."""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled

# asin(sqrt(z)) / sqrt(z) on [0, 1/2] as _S ((((w + z + _G) w + _D) z + _E) z + _F) with w = (z + _A) z + _B: the best
# polynomial of degree 6 (to 1.0e-7; 2.6e-7 in float32) with Knuth's adapted coefficients, a third fewer multiplications
# than Horner's. _S waits until the end: _RIGHT is a quarter turn in its unit.
_A, _B, _G, _D, _E, _F = (
    np.float32(c) for c in (-0.7817083182, 0.9819311149, -1.1848712349, 0.9336943332, 1.6196566155, 9.7190403196)
)
_S = 0.1028908273
_RIGHT = np.float32(np.pi / 2 / _S)
_ZERO, _HALF, _ONE = (np.float32(c) for c in (0.0, 0.5, 1.0))
_ROWS, _POINTS = 4, 8192


@compiled(inline="always", fastmath=True, error_model="numpy")
def _half_arc(across, along, up):
    """Half the arc between two unit vectors, in units of ``_S``, from half their difference.

    By half the chord, so that small arcs keep their digits: sin(arc / 2) = |x - y| / 2, beyond a right angle by the
    complement, which leaves one square root a pair.
    """
    square = across * across + along * along + up * up
    far = square > _HALF
    z = abs(_ONE - square) if far else square
    w = (z + _A) * z + _B
    p = (((w + (z + _G)) * w + _D) * z + _E) * z + _F
    r = np.sqrt(z) * p
    return _RIGHT - r if far else r


# NOTE: fastmath lets the sums over the points run in lanes; no infinity or NaN comes in (the caller checks).
@compiled(fastmath=True, error_model="numpy", nogil=True)
def _half_arcs(x0, x1, x2, y0, y1, y2):
    """Sum of half the arcs between halves of unit vectors (x0, x1, x2) and (y0, y1, y2), (P,) each."""
    total = _ZERO
    for k in range(x0.size):
        total += _half_arc(x0[k] - y0[k], x1[k] - y1[k], x2[k] - y2[k])
    return total


# NOTE: two rows against one at a time, since every number of y is then read once for two arcs: an eighth less time.
@compiled(fastmath=True, error_model="numpy", nogil=True)
def _half_arcs_of_two(x0, x1, x2, w0, w1, w2, y0, y1, y2):
    """The same of x and of w with y."""
    total, second = _ZERO, _ZERO
    for k in range(x0.size):
        total += _half_arc(x0[k] - y0[k], x1[k] - y1[k], x2[k] - y2[k])
        second += _half_arc(w0[k] - y0[k], w1[k] - y1[k], w2[k] - y2[k])
    return total, second


@compiled(nogil=True)
def add_arcs(a, b, first, last, symmetric, out):
    """Add to out (n, m) the summed arcs between rows first:last of a (n, 3, P) and rows of b (m, 3, P), float32.

    a, b : HALVES of unit vectors; symmetric : a is b, and only columns right of the diagonal are filled
    In blocks: ``_ROWS`` rows of a over ``_POINTS`` points stay in the cache while the rows of b pass by.
    """
    points = a.shape[2]
    for low in range(first, last, _ROWS):
        high = min(low + _ROWS, last)
        for start in range(0, points, _POINTS):
            end = min(start + _POINTS, points)
            for j in range(low + 1 if symmetric else 0, b.shape[0]):
                y0, y1, y2 = b[j, 0, start:end], b[j, 1, start:end], b[j, 2, start:end]
                i, stop = low, min(high, j) if symmetric else high
                while i < stop:
                    x0, x1, x2 = a[i, 0, start:end], a[i, 1, start:end], a[i, 2, start:end]
                    if i + 1 < stop:
                        w0, w1, w2 = a[i + 1, 0, start:end], a[i + 1, 1, start:end], a[i + 1, 2, start:end]
                        one, two = _half_arcs_of_two(x0, x1, x2, w0, w1, w2, y0, y1, y2)
                        out[i, j] += 2.0 * _S * one
                        out[i + 1, j] += 2.0 * _S * two
                    else:
                        out[i, j] += 2.0 * _S * _half_arcs(x0, x1, x2, y0, y1, y2)
                    i += 2


@compiled(nogil=True)
def halved(sequences, out):
    """Halves of vectors (n, P, 3) into out (n, 3, P) float32; whether all of them are finite."""
    finite = True
    for n in range(sequences.shape[0]):
        for k in range(sequences.shape[1]):
            for c in range(3):
                half = np.float32(0.5 * sequences[n, k, c])
                finite &= np.isfinite(half)
                out[n, c, k] = half
    return finite
