"""Sums of arcs between many pairs of long rows of unit vectors. Its twins: sequence_distances.distances_numpy, tests.

Between neighbours on the sphere, many at a time: series only, so that the loops vectorise.

Its twin: geometry.flattening.along_numpy.

Postures at any moment from tangent coordinates on the common clock: series only, so that the loops vectorise.

Between the points of the clock coordinates go along cubic B-splines, so that speed and acceleration do not jump.
Its twin: decoding.directions_numpy.

Directions turned bone by bone. Its twin: matrices and einsum in tests/emulator/test_bone_turns.py.

The way uphill from every point to a mode. Its twin: a plain double loop in tests/emulator/judge.
"""

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


FAST = {"contract", "nsz"}  # only what changes no rule: fused multiply-add and no signed zeros


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def shares(u, series, p, q):
    """Coefficients p, q (8,), in the squared chord, of the points' parts at share u of the way from one to the other.

    series (7, 2), see ``geodesic.series``. Source: Eberly, A fast and accurate algorithm for computing SLERP (2011).
    """
    v = 1.0 - u
    q[0], p[0] = u, v
    for i in range(7):
        q[i + 1] = q[i] * (series[i, 0] * u * u + series[i, 1])
        p[i + 1] = p[i] * (series[i, 0] * v * v + series[i, 1])


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def along(points, place, series, largest, coefficients, out):
    """Points out (S, 3B) at places (S,) in cells of points (T, 3B); returns how many neighbours are too far apart.

    largest : the greatest squared chord; coefficients (2, 8) is scratch
    """
    p, q = coefficients[0], coefficients[1]
    n_bones = points.shape[1] // 3
    beyond = 0
    for s in range(place.size):
        cell = min(int(place[s]), len(points) - 2)
        shares(place[s] - cell, series, p, q)
        p0, p1, p2, p3, p4, p5, p6, p7 = p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]
        q0, q1, q2, q3, q4, q5, q6, q7 = q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7]
        here, there, to = points[cell], points[cell + 1], out[s]
        for b in range(n_bones):
            hx, hy, hz = here[3 * b], here[3 * b + 1], here[3 * b + 2]
            tx, ty, tz = there[3 * b], there[3 * b + 1], there[3 * b + 2]
            e = (tx - hx) * (tx - hx) + (ty - hy) * (ty - hy) + (tz - hz) * (tz - hz)
            beyond += e > largest
            h = p0 + e * (p1 + e * (p2 + e * (p3 + e * (p4 + e * (p5 + e * (p6 + e * p7))))))
            t = q0 + e * (q1 + e * (q2 + e * (q3 + e * (q4 + e * (q5 + e * (q6 + e * q7))))))
            to[3 * b], to[3 * b + 1], to[3 * b + 2] = h * hx + t * tx, h * hy + t * ty, h * hz + t * tz
    return beyond


PITCH = 128
"""Bones a posture can have here. A constant distance between rows of ``frame``: one overlap check instead of nine."""


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def inverse_places(warps, own, place):
    """Where the moments own (n, S) of own time lie on warps (n, T), in cells: into place (n, S), ends held."""
    n, last = warps.shape[0], warps.shape[1] - 1
    for i in range(n):
        warp = warps[i]
        cell = 0
        for s in range(own.shape[1]):
            at = min(max(own[i, s], warp[0]), warp[last])
            if at < warp[cell]:
                cell = max(np.searchsorted(warp, at) - 1, 0)
            while cell < last - 1 and warp[cell + 1] <= at:
                cell += 1
            place[i, s] = cell + (at - warp[cell]) / (warp[cell + 1] - warp[cell])


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def spline_weights(u, weight):
    """Weights (4,) of the control points about a share u of a cell, of a uniform cubic B-spline (de Boor 1978)."""
    v = 1.0 - u
    weight[0] = v * v * v / 6.0
    weight[1] = (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0
    weight[2] = (3.0 * v * v * v - 6.0 * v * v + 4.0) / 6.0
    weight[3] = u * u * u / 6.0


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def along_spline(control, place, weight, out):
    """Values out (S, C) at places (S,) in cells of control points (T + 2, C); weight (4,) is scratch."""
    for s in range(place.size):
        cell = min(int(place[s]), control.shape[0] - 4)
        spline_weights(place[s] - cell, weight)
        w0, w1, w2, w3 = weight[0], weight[1], weight[2], weight[3]
        p, q, r, t, to = control[cell], control[cell + 1], control[cell + 2], control[cell + 3], out[s]
        for c in range(to.size):
            to[c] = w0 * p[c] + w1 * q[c] + w2 * r[c] + w3 * t[c]


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def to_directions(coordinates, wave, frame, largest, out):
    """Directions out (3B,) of tangent coordinates (2B,), pairs (x, y); returns how many pairs are too long.

    wave (2, 8)        : the series of cos t and sin t / t in t squared, taken at a quarter of the angle, doubled twice
    frame (9 * PITCH,) : how a bone's pole and tangent axes stand in the room, row by row of its matrix
    """
    one, two = wave[0, 0], wave[0, 0] + wave[0, 0]
    c1, c2, c3, c4, c5, c6, c7 = wave[0, 1], wave[0, 2], wave[0, 3], wave[0, 4], wave[0, 5], wave[0, 6], wave[0, 7]
    s1, s2, s3, s4, s5, s6, s7 = wave[1, 1], wave[1, 2], wave[1, 3], wave[1, 4], wave[1, 5], wave[1, 6], wave[1, 7]
    sixteenth = one / (two * two * two * two)
    beyond = 0
    for b in range(coordinates.size // 2):
        first, second = coordinates[2 * b], coordinates[2 * b + 1]
        square = first * first + second * second
        beyond += square > largest
        h = square * sixteenth
        cosine = one + h * (c1 + h * (c2 + h * (c3 + h * (c4 + h * (c5 + h * (c6 + h * c7))))))
        sinc = one + h * (s1 + h * (s2 + h * (s3 + h * (s4 + h * (s5 + h * (s6 + h * s7))))))
        half = one - two * (sinc * sinc * h)
        sinc *= cosine * half
        x, y, z = one - two * (one - half) * (one + half), sinc * first, sinc * second
        out[3 * b] = frame[b] * x + frame[PITCH + b] * y + frame[2 * PITCH + b] * z
        out[3 * b + 1] = frame[3 * PITCH + b] * x + frame[4 * PITCH + b] * y + frame[5 * PITCH + b] * z
        out[3 * b + 2] = frame[6 * PITCH + b] * x + frame[7 * PITCH + b] * y + frame[8 * PITCH + b] * z
    return beyond


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def decode_block(control, place, largest, wave, frame, scratch, out, beyond):
    """Control points (n, T + 2, 2B) and places (n, S) of the common clock, in cells -> directions out (n, S, 3B).

    beyond (n,) counts coordinates longer than the square root of ``largest``; scratch (2B + 4,).
    """
    number = control.dtype.type
    at, weight = scratch[: control.shape[2]], scratch[control.shape[2] :]
    for i in range(control.shape[0]):
        for s in range(place.shape[1]):
            cell = min(int(place[i, s]), control.shape[1] - 4)
            spline_weights(number(place[i, s] - cell), weight)
            w0, w1, w2, w3 = weight[0], weight[1], weight[2], weight[3]
            p, q, r, t = control[i, cell], control[i, cell + 1], control[i, cell + 2], control[i, cell + 3]
            for c in range(at.size):
                at[c] = w0 * p[c] + w1 * q[c] + w2 * r[c] + w3 * t[c]
            beyond[i] += to_directions(at, wave, frame, largest, out[i, s])


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def decode_vectors(control, place, shortest, scratch, out):
    """The same of control points (n, T + 2, 3B) of the vectors themselves: made unit, unless ``shortest`` or less."""
    number = control.dtype.type
    weight = scratch[:4]
    for i in range(control.shape[0]):
        for s in range(place.shape[1]):
            cell = min(int(place[i, s]), control.shape[1] - 4)
            spline_weights(number(place[i, s] - cell), weight)
            w0, w1, w2, w3 = weight[0], weight[1], weight[2], weight[3]
            p, q, r, t = control[i, cell], control[i, cell + 1], control[i, cell + 2], control[i, cell + 3]
            to = out[i, s]
            for c in range(to.size):
                to[c] = w0 * p[c] + w1 * q[c] + w2 * r[c] + w3 * t[c]
            for b in range(to.size // 3):
                x, y, z = to[3 * b], to[3 * b + 1], to[3 * b + 2]
                less = number(1) / max(np.sqrt(x * x + y * y + z * z), shortest)
                to[3 * b], to[3 * b + 1], to[3 * b + 2] = x * less, y * less, z * less


@compiled(nogil=True)
def uphill(distances, density, radius):
    """The nearest point of higher density within ``radius`` of each point (n,), itself where there is none: a mode.

    Of equal densities the lower number is the higher; of equal distances the lower number is the nearer.
    """
    n = density.size
    above = np.arange(n)
    for i in range(n):
        nearest = radius
        for j in range(n):
            if distances[i, j] < nearest and (density[j] > density[i] or (density[j] == density[i] and j < i)):
                nearest = distances[i, j]
                above[i] = j
    return above


@compiled(error_model="numpy", nogil=True)
def turn_bones(directions, turns):
    """Directions (n, S, B, 3), in place, each bone's turned by its own matrix of turns (n, B, 3, 3)."""
    for i in range(directions.shape[0]):
        for s in range(directions.shape[1]):
            for b in range(turns.shape[1]):
                x, y, z = directions[i, s, b, 0], directions[i, s, b, 1], directions[i, s, b, 2]
                for c in range(3):
                    directions[i, s, b, c] = turns[i, b, c, 0] * x + turns[i, b, c, 1] * y + turns[i, b, c, 2] * z
