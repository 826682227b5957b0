"""Square-root velocity fields: made from postures, and carried along warps.

Their twins: elastic.tsrvf_numpy, fields.warped_numpy, tests/naive.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.geodesic import FAST


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
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


@compiled(fastmath=FAST | {"reassoc"}, error_model="numpy", nogil=True)
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


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
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
