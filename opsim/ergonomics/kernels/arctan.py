"""Many arc tangents at once: arithmetic only, so that the loop vectorises. Twin: ``numpy.arctan2``."""

from __future__ import annotations

import math

from opsim.ergonomics.kernels.compiled import compiled

DEGREES = 180.0 / math.pi


@compiled(error_model="numpy", nogil=True)
def arctan2_deg(opposite, adjacent, out):
    """Angles of pairs, each flat (N,), into out (N,): degrees from -180 to 180; nan where both are 0 or one is nan.

    The tangent is brought below tan(22.5 deg); then t + t z P(z) / Q(z), z = t^2, good to 2e-16.
    Source: Moshier 1989, Cephes mathematical library, atan.c.
    """
    for i in range(out.size):
        y, x = opposite[i], adjacent[i]
        up, along = abs(y), abs(x)
        over = up > along  # NOTE: false where either is nan, which then is in large or small; max and min lose it
        large, small = up if over else along, along if over else up
        steep = small > 0.41421356237309503 * large
        t = (small - large if steep else small) / (small + large if steep else large)
        z = t * t
        p = (((-0.8750608600031904 * z - 16.15753718733365) * z - 75.00855792314705) * z - 122.88666844901361) * z
        p -= 64.85021904942025
        q = ((((z + 24.858464901423062) * z + 165.02700983169885) * z + 432.88106049129027) * z + 485.3903996359137) * z
        q += 194.5506571482614
        angle = t + t * (z * p / q)
        angle += 0.7853981633974483 if steep else 0.0
        angle = 1.5707963267948966 - angle if over else angle
        angle = 3.141592653589793 - angle if x < 0.0 else angle
        out[i] = math.copysign(DEGREES * angle, y)
