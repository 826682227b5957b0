"""Postures at any moment from tangent coordinates on the common clock: series only, so that the loops vectorise.

Between the points of the clock coordinates go along cubic B-splines, so that speed and acceleration do not jump.
Its twin: decode.directions_numpy.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.geodesic import FAST

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
