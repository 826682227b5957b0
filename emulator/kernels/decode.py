"""Postures at any moment from tangent coordinates on the common clock: series only, so that the loops vectorise.

Its twin: decode.directions_numpy.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.geodesic import FAST, shares

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
def count_beyond(coordinates, apart, largest_turn, largest_step):
    """How many pairs (x, y) of the flat coordinates are too long, or too far from the pair ``apart`` numbers later."""
    later = coordinates[apart:]
    n = later.size // 2
    beyond = 0
    for i in range(n):
        x, y = coordinates[2 * i], coordinates[2 * i + 1]
        dx, dy = later[2 * i] - x, later[2 * i + 1] - y
        beyond += (x * x + y * y > largest_turn) | (dx * dx + dy * dy > largest_step)
    for i in range(n, coordinates.size // 2):
        beyond += coordinates[2 * i] ** 2 + coordinates[2 * i + 1] ** 2 > largest_turn
    return beyond


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def to_sphere(coordinates, wave, ahead, first, second):
    """The points reached from the pole along flat pairs (x, y): their three coordinates, each (P,), written here.

    wave (2, 8) : the series of cos t and sin t / t in t squared. Taken at a quarter of the angle and doubled twice.
    """
    one, two = wave[0, 0], wave[0, 0] + wave[0, 0]
    c1, c2, c3, c4, c5, c6, c7 = wave[0, 1], wave[0, 2], wave[0, 3], wave[0, 4], wave[0, 5], wave[0, 6], wave[0, 7]
    s1, s2, s3, s4, s5, s6, s7 = wave[1, 1], wave[1, 2], wave[1, 3], wave[1, 4], wave[1, 5], wave[1, 6], wave[1, 7]
    sixteenth = one / (two * two * two * two)
    for i in range(ahead.size):
        x, y = coordinates[2 * i], coordinates[2 * i + 1]
        h = (x * x + y * y) * sixteenth
        cosine = one + h * (c1 + h * (c2 + h * (c3 + h * (c4 + h * (c5 + h * (c6 + h * c7))))))
        sinc = one + h * (s1 + h * (s2 + h * (s3 + h * (s4 + h * (s5 + h * (s6 + h * s7))))))
        half = one - two * (sinc * sinc * h)
        sinc *= cosine * half
        ahead[i] = one - two * (one - half) * (one + half)
        first[i] = sinc * x
        second[i] = sinc * y


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def along_geodesics(ahead, first, second, n_bones, place, frame, series, out):
    """Directions out (S, 3B) at places (S,) of the common clock, given the points of ``to_sphere``, each (T * B,).

    frame (9 * PITCH,) : how a bone's pole and tangent axes stand in the room, row by row of its matrix
    series (7, 2)      : see ``geodesic.series``
    """
    n_times = ahead.size // n_bones
    number = ahead.dtype.type
    u, v = np.empty(8), np.empty(8)
    for s in range(place.size):
        cell = min(int(place[s]), n_times - 2)
        shares(place[s] - cell, series, v, u)
        u0, u1, u2, u3 = number(u[0]), number(u[1]), number(u[2]), number(u[3])
        u4, u5, u6, u7 = number(u[4]), number(u[5]), number(u[6]), number(u[7])
        v0, v1, v2, v3 = number(v[0]), number(v[1]), number(v[2]), number(v[3])
        v4, v5, v6, v7 = number(v[4]), number(v[5]), number(v[6]), number(v[7])
        here, there = cell * n_bones, (cell + 1) * n_bones
        p_ahead, p_first, p_second = ahead[here:], first[here:], second[here:]
        q_ahead, q_first, q_second = ahead[there:], first[there:], second[there:]
        to = out[s]
        for b in range(n_bones):
            p0, p1, p2 = p_ahead[b], p_first[b], p_second[b]
            q0, q1, q2 = q_ahead[b], q_first[b], q_second[b]
            e = (q0 - p0) * (q0 - p0) + (q1 - p1) * (q1 - p1) + (q2 - p2) * (q2 - p2)
            q = u0 + e * (u1 + e * (u2 + e * (u3 + e * (u4 + e * (u5 + e * (u6 + e * u7))))))
            p = v0 + e * (v1 + e * (v2 + e * (v3 + e * (v4 + e * (v5 + e * (v6 + e * v7))))))
            x, y, z = p * p0 + q * q0, p * p1 + q * q1, p * p2 + q * q2
            to[3 * b] = frame[b] * x + frame[PITCH + b] * y + frame[2 * PITCH + b] * z
            to[3 * b + 1] = frame[3 * PITCH + b] * x + frame[4 * PITCH + b] * y + frame[5 * PITCH + b] * z
            to[3 * b + 2] = frame[6 * PITCH + b] * x + frame[7 * PITCH + b] * y + frame[8 * PITCH + b] * z


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def decode_block(coordinates, place, limits, wave, frame, series, points, out, beyond):
    """All of the above for the sequences of a block: coordinates (n, 2 * T * B), place (n, S) -> out (n, S, 3B).

    A sequence with coordinates beyond the limits (2,) is left alone and counted in beyond (n,); points (3, T * B) is
    scratch.
    """
    n_bones = out.shape[2] // 3
    for i in range(coordinates.shape[0]):
        beyond[i] = count_beyond(coordinates[i], 2 * n_bones, limits[0], limits[1])
        if beyond[i] == 0:
            to_sphere(coordinates[i], wave, points[0], points[1], points[2])
            along_geodesics(points[0], points[1], points[2], n_bones, place[i], frame, series, out[i])
