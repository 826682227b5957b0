"""Between values without a jump of the slope and without overshoot. Twin: scipy's PchipInterpolator.

Source: Fritsch & Butland (1984), A method for constructing local monotone piecewise cubic interpolants.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled


@compiled(error_model="numpy", nogil=True)
def edge_slope(near_width, next_width, near_slope, next_slope):
    """The slope at an end, from the widths and slopes of the two cells nearest to it."""
    slope = ((2.0 * near_width + next_width) * near_slope - near_width * next_slope) / (near_width + next_width)
    if slope * near_slope <= 0:
        return 0.0
    if near_slope * next_slope <= 0 and abs(slope) > 3.0 * abs(near_slope):
        return 3.0 * near_slope
    return slope


@compiled(error_model="numpy", nogil=True)
def slopes(x, y, slope):
    """Writes the slope (n,) at each of the points (x, y), n at least 2."""
    n = x.size
    if n == 2:
        slope[:] = (y[1] - y[0]) / (x[1] - x[0])
        return
    for k in range(1, n - 1):
        before, after = x[k] - x[k - 1], x[k + 1] - x[k]
        low, high = (y[k] - y[k - 1]) / before, (y[k + 1] - y[k]) / after
        one, other = 2.0 * after + before, after + 2.0 * before
        slope[k] = (one + other) / (one / low + other / high) if low * high > 0 else 0.0
    rise = np.diff(y) / np.diff(x)
    slope[0] = edge_slope(x[1] - x[0], x[2] - x[1], rise[0], rise[1])
    slope[n - 1] = edge_slope(x[n - 1] - x[n - 2], x[n - 2] - x[n - 3], rise[n - 2], rise[n - 3])


@compiled(error_model="numpy", nogil=True)
def monotone(x, y, at, out):
    """Writes out (m, c) at rising places (m,), between points (n,) and y (c, n); places lie within the points."""
    slope = np.empty(x.size)
    for c in range(y.shape[0]):
        slopes(x, y[c], slope)
        k = 0
        for i in range(at.size):
            while k < x.size - 2 and x[k + 1] <= at[i]:
                k += 1
            width = x[k + 1] - x[k]
            u = (at[i] - x[k]) / width
            rise = (y[c, k + 1] - y[c, k]) / width
            bend, twist = 3.0 * rise - 2.0 * slope[k] - slope[k + 1], slope[k] + slope[k + 1] - 2.0 * rise
            out[i, c] = y[c, k] + width * u * (slope[k] + u * (bend + u * twist))
