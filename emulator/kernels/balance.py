"""Balance: how far a centre of mass is from between the feet that carry it, seen from above, and what brings it back.

Its twin: off_feet and held_up in tests/naive/footing.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled


@compiled(error_model="numpy", nogil=True)
def off_feet(centre, places, weight, t, out):
    """The way out (2,) to a centre of mass from the nearest place between two feet, seen from above; returns how far.

    places (2, 2, T) : the middles of the feet, weight (2, T) : how much each carries, here at point t; one that carries
        little is drawn in
    """
    total = max(weight[0, t] + weight[1, t], 1e-300)
    along, square = 0.0, 1e-12
    for c in range(2):
        out[c] = centre[c] - (weight[0, t] * places[0, c, t] + weight[1, t] * places[1, c, t]) / total
        way = places[1, c, t] - places[0, c, t]
        along += out[c] * way
        square += way * way
    less = min(2.0 * weight[0, t], 2.0 * weight[1, t], total) / total
    share = min(max(along / square, -less * weight[1, t] / total), less * weight[0, t] / total)
    for c in range(2):
        out[c] -= share * (places[1, c, t] - places[0, c, t])
    return np.sqrt(out[0] ** 2 + out[1] ** 2)


@compiled(error_model="numpy", nogil=True)
def strayed(centres, places, weight, out):
    """How far each centre of mass (T, 2) is from between the feet, places (2, 2, T), out (T,); see ``off_feet``."""
    way = np.empty(2)
    for t in range(out.size):
        out[t] = off_feet(centres[t], places, weight, t, way)


@compiled(error_model="numpy", nogil=True)
def held_up(bodies, mass, places, weight, stray_m, out):
    """By how much a body is to move, out (2, T), level, to be no farther off its feet than stray_m (T,).

    bodies (T, J, 3); mass (J,) : shares of the joints in the centre of mass; places, weight : as for ``strayed``
    Returns whether it is to move at all.
    """
    centre, way, moved = np.empty(2), np.empty(2), False
    for t in range(stray_m.size):
        out[0, t] = out[1, t] = 0.0
        if not np.isfinite(stray_m[t]):
            continue
        centre[:] = 0.0
        for j in range(mass.size):
            centre[0] += mass[j] * bodies[t, j, 0]
            centre[1] += mass[j] * bodies[t, j, 1]
        far = off_feet(centre, places, weight, t, way)
        if far > stray_m[t]:
            moved = True
            for c in range(2):
                out[c, t] = -way[c] * (far - stray_m[t]) / max(far, 1e-12)
    return moved
