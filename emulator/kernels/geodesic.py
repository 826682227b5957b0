"""Between neighbours on the sphere, many at a time: series only, so that the loops vectorise.

Its twin: geodesic.along_numpy.
"""

from __future__ import annotations

from emulator.kernels.compiled import compiled

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
