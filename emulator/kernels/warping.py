"""The row stencil of the elastic dynamic programme, and the way back.

Its twins: elastic.optimum_numpy, tests/naive.
Arrays are walked flat, with unsigned places: a signed one might be negative, and numba would test every element
for it (4 times slower); a slice for every tap costs as much as 80 of its elements.

Square-root velocity fields: made from postures, and carried along warps.

Their twins: elastic.tsrvf_numpy, elastic.warped_numpy, tests/naive.

Between values without a jump of the slope and without overshoot. Twin: scipy's PchipInterpolator.

Source: Fritsch & Butland (1984), A method for constructing local monotone piecewise cubic interpolants.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.sphere import FAST as FAST_sphere

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


@compiled(fastmath=FAST_sphere, error_model="numpy", nogil=True)
def transported(postures, reference, inverse_sine, largest, out):
    """Velocities out (T - 1, 3B) of postures (T, 3B), a unit of [0, 1], carried to reference (3B,).

    inverse_sine (8,) : the series of angle / sin(angle) in the squared chord. Returns how many bones turn more than
    the squared chord ``largest`` in a cell, or point away from the reference: those are wrong.
    """
    cells = len(postures) - 1
    f0, f1, f2, f3 = inverse_sine[0], inverse_sine[1], inverse_sine[2], inverse_sine[3]
    f4, f5, f6, f7 = inverse_sine[4], inverse_sine[5], inverse_sine[6], inverse_sine[7]
    beyond = 0
    for t in range(cells):
        here, there, to = postures[t], postures[t + 1], out[t]
        for b in range(reference.size // 3):
            hx, hy, hz = here[3 * b], here[3 * b + 1], here[3 * b + 2]
            rx, ry, rz = reference[3 * b], reference[3 * b + 1], reference[3 * b + 2]
            dx, dy, dz = there[3 * b] - hx, there[3 * b + 1] - hy, there[3 * b + 2] - hz
            e = dx * dx + dy * dy + dz * dz
            angle = cells * (f0 + e * (f1 + e * (f2 + e * (f3 + e * (f4 + e * (f5 + e * (f6 + e * f7)))))))
            inward = 0.5 * e  # the chord less its part along the base is the tangent
            vx, vy, vz = angle * (dx + inward * hx), angle * (dy + inward * hy), angle * (dz + inward * hz)
            near = 1.0 + hx * rx + hy * ry + hz * rz
            beyond += (e > largest) | (near < 1e-3)
            back = (rx * vx + ry * vy + rz * vz) / near
            to[3 * b], to[3 * b + 1], to[3 * b + 2] = (
                vx - back * (hx + rx),
                vy - back * (hy + ry),
                vz - back * (hz + rz),
            )
    return beyond


@compiled(fastmath=FAST_sphere | {"reassoc"}, error_model="numpy", nogil=True)
def root_speed(field):
    """Each row of field (T, D) over the square root of its length, in place; a row shorter than 1e-12 becomes 0."""
    for t in range(field.shape[0]):
        row = field[t]
        square = 0.0
        for d in range(row.size):
            square += row[d] * row[d]
        speed = np.sqrt(square)
        factor = 1.0 / np.sqrt(speed) if speed > 1e-12 else 0.0
        for d in range(row.size):
            row[d] *= factor


@compiled(fastmath=FAST_sphere, error_model="numpy", nogil=True)
def warp_field(field, gamma, out):
    """(q o gamma) sqrt(gamma') of field (N, D), averaged over each cell of gamma's clock: out (T - 1, D)."""
    n = field.shape[0]
    for t in range(gamma.size - 1):
        start, stop = gamma[t] * n, gamma[t + 1] * n
        row = out[t]
        row[:] = 0.0
        for k in range(min(int(start), n - 1), min(int(np.ceil(stop)), n)):
            share = min(stop, k + 1.0) - max(start, float(k))
            q = field[k]
            for d in range(row.size):
                row[d] += share * q[d]
        factor = np.sqrt((gamma.size - 1) * (gamma[t + 1] - gamma[t])) / (stop - start)
        for d in range(row.size):
            row[d] *= factor


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


NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)
NODES, WEIGHTS = (NODES + 1.0) / 2.0, WEIGHTS / 2.0
"""Of Gauss-Legendre's rule of four on [0, 1]."""


@compiled(error_model="numpy", nogil=True)
def spline_warps_at(control, moments, share):
    """Fill share (N, E): warps whose log slope is the cubic spline of control (N, K) at moments (N, E) of the clock.

    Between two control points, and from the ends to the outermost ones, the slope is integrated by Gauss-Legendre's
    rule of four. Twin: warps.from_clr on a fine clock.
    """
    n, k = control.shape
    level, cubic = np.zeros(k + 2), np.empty((k + 1, 4))
    for i in range(n):
        for p in range(k + 1):
            c0, c1 = control[i, min(max(p - 2, 0), k - 1)], control[i, min(max(p - 1, 0), k - 1)]
            c2, c3 = control[i, min(p, k - 1)], control[i, min(p + 1, k - 1)]
            cubic[p, 0], cubic[p, 1] = (c0 + 4.0 * c1 + c2) / 6.0, (c2 - c0) / 2.0
            cubic[p, 2], cubic[p, 3] = (c0 - 2.0 * c1 + c2) / 2.0, (c3 - 3.0 * c2 + 3.0 * c1 - c0) / 6.0
            level[p + 1] = level[p] + _integral(cubic[p], 0.5 if p == 0 else 0.0, 0.5 if p == k else 1.0)
        for e in range(moments.shape[1]):
            place = moments[i, e] * k + 0.5
            p = min(int(place), k)
            part = _integral(cubic[p], 0.5 if p == 0 else 0.0, place - p)
            share[i, e] = (level[p] + part) / level[k + 1]


@compiled(error_model="numpy", nogil=True)
def _integral(cubic, first, last):
    """Of exp(cubic) from first to last."""
    width, total = last - first, 0.0
    for g in range(4):
        u = first + width * NODES[g]
        total += WEIGHTS[g] * np.exp(cubic[0] + u * (cubic[1] + u * (cubic[2] + u * cubic[3])))
    return total * width
