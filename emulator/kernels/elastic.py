"""The row stencil of the elastic dynamic programme, and the way back.

Its twins: elastic.optimum_numpy, tests/naive.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled


# NOTE: two taps a pass on purpose: tmp is read and written half as often.
# fastmath only where it changes no rule: fused multiply-add and no signed zeros; infinities and NaN keep their meaning.
@compiled(fastmath={"contract", "nsz"}, error_model="numpy", nogil=True)
def fill(kernel, rises, runs, tap_row, tap_column, tap_weight, first, value, move, tmp, best, arg):
    """Fill value (N + 1, M + 1) and move (N + 1, M + 1) row by row; returns the optimum value[N, M].

    kernel (N, M); move s goes ``rises[s]`` rows and ``runs[s]`` columns back, at least 1, so a row only needs
    earlier rows; its taps are first[s]:first[s + 1] of tap_row, tap_column, tap_weight; tmp, best, arg are scratch.
    """
    n, m = kernel.shape
    value[:] = -1e30
    value[0, 0] = 0.0
    for i in range(1, n + 1):
        best[:] = -1e30
        arg[:] = 0
        for s in range(rises.size):
            p, q = rises[s], runs[s]
            if i < p:
                continue
            width = m + 1 - q
            earlier = value[i - p]
            for j in range(width):
                tmp[j] = earlier[j]
            t, last = first[s], first[s + 1]
            while t + 1 < last:
                w0, k0 = tap_weight[t], kernel[i - p + tap_row[t], tap_column[t] :]
                w1, k1 = tap_weight[t + 1], kernel[i - p + tap_row[t + 1], tap_column[t + 1] :]
                for j in range(width):
                    tmp[j] += w0 * k0[j] + w1 * k1[j]
                t += 2
            if t < last:
                w0, k0 = tap_weight[t], kernel[i - p + tap_row[t], tap_column[t] :]
                for j in range(width):
                    tmp[j] += w0 * k0[j]
            best_q, arg_q = best[q:], arg[q:]
            for j in range(width):
                better = tmp[j] > best_q[j]
                best_q[j] = tmp[j] if better else best_q[j]
                arg_q[j] = s if better else arg_q[j]
        for j in range(1, m + 1):
            value[i, j] = best[j]
            move[i, j] = arg[j]
    return value[n, m]


@compiled(nogil=True)
def way_back(move, rises, runs):
    """The nodes of the best path from (0, 0) to the far corner: (E, 2) rows and columns."""
    i, j = move.shape[0] - 1, move.shape[1] - 1
    nodes = np.empty((i + 1, 2), dtype=np.int64)
    n = 0
    while True:
        nodes[n, 0] = i
        nodes[n, 1] = j
        n += 1
        if i <= 0 or j <= 0:
            return nodes[:n][::-1].copy()
        s = move[i, j]
        i -= rises[s]
        j -= runs[s]
