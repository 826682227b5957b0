"""The row stencil of the elastic dynamic programme, and the way back.

Its twins: elastic.optimum_numpy, tests/naive.py.
Arrays are walked flat, with unsigned places: a signed one might be negative, and numba would test every element
for it (4 times slower); a slice for every tap costs as much as 80 of its elements.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled

# Only what changes no rule: fused multiply-add and no signed zeros; infinities and NaN keep their meaning.
FAST = {"contract", "nsz"}
FAR = -1e30


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def fill(kernel, rises, runs, tap_row, tap_column, tap_weight, first, tails, bound, value, low, high, scratch):
    """Fill value (N + 1, M + 1) row by row between columns low and high (N + 1,), and return value[N, M].

    kernel (N, M); move s goes ``rises[s]`` rows and ``runs[s]`` columns back, at least 1, so a row only needs
    earlier rows; its taps first[s]:first[s + 1] are even in number. ``tails`` are two arrays (N + 1,) and (M + 1,): a
    node that with tails[0][i] * tails[1][j] to come stays below ``bound`` is dropped at the row's ends, and a row's
    columns are those that moves can reach from kept nodes, and from which they can reach the far corner.
    """
    n, m = kernel.shape
    gains, values = kernel.ravel(), value.ravel()
    tap_at = tap_row * m + tap_column
    steep = runs.max()
    low[0], high[0], value[0, 0] = 0, 0, 0.0
    for i in range(1, n + 1):
        start, stop = m + 1, 0
        for p in range(1, min(steep, i) + 1):
            if low[i - p] <= high[i - p]:
                start, stop = min(start, low[i - p] + 1), max(stop, high[i - p] + steep)
        start, stop = max(start, m - steep * (n - i)), min(stop, m - (n - i + steep - 1) // steep)
        value[i, start : stop + 1] = FAR
        for s in range(rises.size):
            p, q = rises[s], runs[s]
            if i < p:
                continue
            left, right = max(start, low[i - p] + q), min(stop, high[i - p] + q)
            if left <= right:
                to, before = np.uint64(i * (m + 1) + left), np.uint64((i - p) * (m + 1) + left - q)
                at, width = (i - p) * m + left - q, np.uint64(right - left + 1)
                keep_best(gains, at, tap_at, tap_weight, first[s], first[s + 1], values, before, to, width, scratch)
        if i < n:
            while start <= stop and value[i, start] + tails[0][i] * tails[1][start] < bound:
                start += 1
            while start <= stop and value[i, stop] + tails[0][i] * tails[1][stop] < bound:
                stop -= 1
        low[i], high[i] = start, stop
    return value[n, m]


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def keep_best(gains, at, tap_at, tap_weight, t, last, values, before, to, width, scratch):
    """values[to:] becomes the larger of itself and values[before:] plus the taps t:last, over ``width`` places.

    NOTE: four taps a pass on purpose: more need more overlap checks than the compiler is willing to write.
    """
    if last - t > 4:
        add_four(gains, at, tap_at, tap_weight, t, values, before, width, scratch)
        t += 4
        while last - t > 4:
            add_four(gains, at, tap_at, tap_weight, t, scratch, np.uint64(0), width, scratch)
            t += 4
        values_before, before = scratch, np.uint64(0)
    else:
        values_before = values
    w0, w1 = tap_weight[t], tap_weight[t + 1]
    k0, k1 = np.uint64(at + tap_at[t]), np.uint64(at + tap_at[t + 1])
    if last - t == 2:
        for j in range(width):
            x = values_before[before + j] + (w0 * gains[k0 + j] + w1 * gains[k1 + j])
            values[to + j] = x if x > values[to + j] else values[to + j]
    else:
        w2, w3 = tap_weight[t + 2], tap_weight[t + 3]
        k2, k3 = np.uint64(at + tap_at[t + 2]), np.uint64(at + tap_at[t + 3])
        for j in range(width):
            x = values_before[before + j] + (w0 * gains[k0 + j] + w1 * gains[k1 + j])
            x += w2 * gains[k2 + j] + w3 * gains[k3 + j]
            values[to + j] = x if x > values[to + j] else values[to + j]


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def add_four(gains, at, tap_at, tap_weight, t, base, before, width, out):
    """out[:width] = base[before:] plus four taps."""
    w0, w1, w2, w3 = tap_weight[t], tap_weight[t + 1], tap_weight[t + 2], tap_weight[t + 3]
    k0, k1 = np.uint64(at + tap_at[t]), np.uint64(at + tap_at[t + 1])
    k2, k3 = np.uint64(at + tap_at[t + 2]), np.uint64(at + tap_at[t + 3])
    for j in range(width):
        x = base[before + j] + (w0 * gains[k0 + j] + w1 * gains[k1 + j])
        out[j] = x + (w2 * gains[k2 + j] + w3 * gains[k3 + j])


@compiled(nogil=True)
def way_back(kernel, rises, runs, tap_row, tap_column, tap_weight, first, value, low, high):
    """The nodes of the best path from (0, 0) to the far corner: (E, 2) rows and columns.

    The move into a node is found anew: a path has few nodes, and storing a move for each of all costs a third more.
    """
    i, j = kernel.shape
    nodes = np.empty((i + 1, 2), dtype=np.int64)
    n = 0
    while True:
        nodes[n, 0] = i
        nodes[n, 1] = j
        n += 1
        if i <= 0 or j <= 0:
            return nodes[:n][::-1].copy()
        best, move = -np.inf, 0
        for s in range(rises.size):
            k, c = i - rises[s], j - runs[s]
            if k >= 0 and low[k] <= c <= high[k]:
                x = value[k, c]
                for t in range(first[s], first[s + 1]):
                    x += tap_weight[t] * kernel[k + tap_row[t], c + tap_column[t]]
                if x > best:
                    best, move = x, s
        i -= rises[move]
        j -= runs[move]
