"""Legs that bend so that ankles go where they belong, and feet that turn: two bones each, and the lengths stay.

Its twin: bent and turned in tests/naive/footing.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.sphere import spline_weights

STRAIGHT = 0.9995
"""The most of its length to which a leg stretches."""
STIFF_KNEE, AHEAD = 0.01, 0.02
"""A leg straight to within the first share of its length keeps its length, and a knee bends at least the second ahead:
else a millimetre of a foot would throw the knee about by centimetres, and bend far back what is bent back a little."""
SIDEWAYS = 0.03
"""Where a leg points ahead itself, within 10 degrees, ahead is no side of it."""
FOLDED = (0.15, 0.35)
"""A leg whose ankle is this near to its hip, in leg lengths, turns about with every millimetre: it follows not at all
below the first, fully above the second; nor does its knee bend ahead."""
MOST_BEND_M = 0.5
"""What legs bend at most, softly: a foot that would have to go farther is where the draw's own posture has it."""


@compiled(error_model="numpy", nogil=True)
def softly(x, y, z):
    """What share of a way (x, y, z) an ankle goes that legs would have to bend by: see ``MOST_BEND_M``."""
    far = (x * x + y * y + z * z) / MOST_BEND_M**2
    return 1.0 / np.sqrt(np.sqrt(1.0 + far * far))


@compiled(error_model="numpy", nogil=True)
def bend_of(moves, t, cosine, sine, out):
    """What a leg must bend and its foot turn at point t, out (6,), without heading, for moves (6, T) with it."""
    by = softly(moves[0, t], moves[1, t], moves[2, t])
    for k in range(0, 6, 3):
        x, y, z = by * moves[k, t], by * moves[k + 1, t], by * moves[k + 2, t]
        out[k], out[k + 1], out[k + 2] = cosine * x + sine * y, cosine * y - sine * x, z
        by = 1.0


@compiled(error_model="numpy", nogil=True)
def unfolded(share):
    """From 0 to 1 as the distance of hip and ankle, as a share of the leg, goes through ``FOLDED``."""
    u = min(max((share - FOLDED[0]) / (FOLDED[1] - FOLDED[0]), 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)


@compiled(error_model="numpy", nogil=True)
def hip_to_ankle(bodies, chain, leg_bones, length_m, leg, follow):
    """Writes the ways (3, T) from hip to ankle of bodies (T, J, 3), and what their legs follow by, (3, T).

    follow : how long the leg is, how much of a move it takes, how much of a longer or shorter way
    """
    hip, ankle = 0, 0
    for k in range(chain.shape[0]):
        if chain[k, 0] == leg_bones[0]:
            hip = chain[k, 1]
        if chain[k, 0] == leg_bones[1]:
            ankle = chain[k, 2]
    full = length_m[leg_bones[0]] + length_m[leg_bones[1]]
    for t in range(leg.shape[1]):
        square = 0.0
        for c in range(3):
            leg[c, t] = bodies[t, ankle, c] - bodies[t, hip, c]
            square += leg[c, t] ** 2
        drawn = np.sqrt(square)
        slack = max(full - drawn, 0.0) / full
        follow[0, t], follow[1, t], follow[2, t] = drawn, unfolded(drawn / full), slack / (slack + STIFF_KNEE)


@compiled(error_model="numpy", nogil=True)
def left_over(moves, leg, follow, leg_bones, length_m, left):
    """Writes by how much an ankle (3, T) misses its moves (3 or more, T) after its leg is bent: see ``bent_leg``.

    leg, follow (3, T) : of ``hip_to_ankle``
    """
    thigh, shank = length_m[leg_bones[0]], length_m[leg_bones[1]]
    least, most = abs(thigh - shank) + 1e-4, STRAIGHT * (thigh + shank)
    for t in range(left.shape[1]):
        x, y, z = moves[0, t], moves[1, t], moves[2, t]
        drawn, by = follow[0, t], follow[1, t] * softly(x, y, z)
        a, b, c = leg[0, t] + by * x, leg[1, t] + by * y, leg[2, t] + by * z
        length = np.sqrt(a * a + b * b + c * c)
        reach = min(max(drawn + (length - drawn) * follow[2, t], least), max(drawn, most))
        by = reach / max(length, 1e-12)
        left[0, t], left[1, t], left[2, t] = x + leg[0, t] - by * a, y + leg[1, t] - by * b, z + leg[2, t] - by * c


@compiled(error_model="numpy", nogil=True)
def soft_plus(x):
    """log(1 + exp(x))."""
    return max(x, 0.0) + np.log(1.0 + np.exp(-abs(x)))


@compiled(error_model="numpy", nogil=True)
def bent_leg(to, upper, lower, thigh, shank, by):
    """Directions ``to`` (3B,) with a leg bent, in place, so that its ankle moves ``by`` (3 or more,).

    upper, lower : its bones' numbers, times 3; thigh, shank : their lengths. A leg that is nearly straight keeps its
    length, one that is folded up keeps all of it; see ``hip_to_ankle``.
    """
    full = thigh + shank
    knee_x, knee_y, knee_z = thigh * to[upper], thigh * to[upper + 1], thigh * to[upper + 2]
    x, y, z = knee_x + shank * to[lower], knee_y + shank * to[lower + 1], knee_z + shank * to[lower + 2]
    drawn = np.sqrt(x * x + y * y + z * z)
    follows, slack = unfolded(drawn / full), max(full - drawn, 0.0) / full
    x, y, z = x + follows * by[0], y + follows * by[1], z + follows * by[2]
    length = np.sqrt(x * x + y * y + z * z)
    less = 1.0 / max(length, 1e-12)
    x, y, z = x * less, y * less, z * less
    reach = drawn + (length - drawn) * slack / (slack + STIFF_KNEE)
    reach = min(max(reach, abs(thigh - shank) + 1e-4), max(drawn, STRAIGHT * full))
    fore = (thigh**2 - shank**2 + reach**2) / (2.0 * reach)
    along, level, least = knee_x * x + knee_y * y + knee_z * z, max(1.0 - x * x, 1e-12), AHEAD * full
    root = np.sqrt(level)
    ahead = (knee_x - along * x) / root
    want = least + least * soft_plus(ahead / least - 1.0)
    more = (want - ahead) * unfolded(reach / full) * root / (level + SIDEWAYS)
    along += more * x
    knee_x, knee_y, knee_z = knee_x + more - along * x, knee_y - along * y, knee_z - along * z
    size = max(np.sqrt(knee_x * knee_x + knee_y * knee_y + knee_z * knee_z), 1e-9)
    out = np.sqrt(max(thigh**2 - fore**2, 0.0)) / size
    knee_x, knee_y, knee_z = fore * x + out * knee_x, fore * y + out * knee_y, fore * z + out * knee_z
    less = 1.0 / thigh
    to[upper], to[upper + 1], to[upper + 2] = less * knee_x, less * knee_y, less * knee_z
    less = 1.0 / shank
    to[lower], to[lower + 1] = less * (reach * x - knee_x), less * (reach * y - knee_y)
    to[lower + 2] = less * (reach * z - knee_z)


@compiled(error_model="numpy", nogil=True)
def turned_height(joint, ankle, was, foot):
    """How high a joint (3,) is above its ankle (3,) after the least turn of the unit vector was (3,) into foot (3,)."""
    both, first, cosine = 0.0, 0.0, 1.0
    for c in range(3):
        way = joint[c] - ankle[c]
        both += (was[c] + foot[c]) * way
        first += was[c] * way
        cosine += was[c] * foot[c]
    return joint[2] - ankle[2] + 2.0 * first * foot[2] - both / max(cosine, 1e-6) * (was[2] + foot[2])


@compiled(error_model="numpy", nogil=True)
def turned_sole(to, length_m, sole, by):
    """Directions ``to`` (3B,) with the bones of a foot turned, in place, so that its unit vector changes by[3:6].

    The least rotation that takes the one vector into the other.
    """
    if sole.size == 0 or sole[0] < 0:
        return
    x, y, z = 0.0, 0.0, 0.0
    for bone in sole:
        if bone >= 0:
            x += length_m[bone] * to[3 * bone]
            y += length_m[bone] * to[3 * bone + 1]
            z += length_m[bone] * to[3 * bone + 2]
    less = 1.0 / max(np.sqrt(x * x + y * y + z * z), 1e-12)
    x, y, z = less * x, less * y, less * z
    now_x, now_y, now_z = x + by[3], y + by[4], z + by[5]
    less = 1.0 / max(np.sqrt(now_x * now_x + now_y * now_y + now_z * now_z), 1e-12)
    now_x, now_y, now_z = less * now_x, less * now_y, less * now_z
    cosine = 1.0 + x * now_x + y * now_y + z * now_z
    if cosine < 1e-6:
        return
    both_x, both_y, both_z = x + now_x, y + now_y, z + now_z
    for bone in sole:
        if bone < 0:
            break
        a, b, c = to[3 * bone], to[3 * bone + 1], to[3 * bone + 2]
        first = 2.0 * (x * a + y * b + z * c)
        both = (both_x * a + both_y * b + both_z * c) / cosine
        to[3 * bone] = a + first * now_x - both * both_x
        to[3 * bone + 1] = b + first * now_y - both * both_y
        to[3 * bone + 2] = c + first * now_z - both * both_z


@compiled(error_model="numpy", nogil=True)
def bent(directions, length_m, legs, soles, place, control):
    """Directions (n, S, 3B) with the legs bent, in place, so that ankles and feet move by what ``footed`` wants.

    legs (2, 2) : bones to knee and to ankle of each side; soles (2, K) : bones from ankle to toe, -1 for none more
    control (n, 2, T + 2, 6) : control points of the bends, at places (n, S), in cells
    Two bones: the lengths stay, the knee keeps to its side (the plane of hip, knee, ankle).
    """
    by, weight = np.empty(6), np.empty(4)
    for i in range(directions.shape[0]):
        for f in range(2):
            upper, lower = legs[f, 0], legs[f, 1]
            thigh, shank = length_m[i, upper], length_m[i, lower]
            for s in range(place.shape[1]):
                cell = min(int(place[i, s]), control.shape[2] - 4)
                spline_weights(place[i, s] - cell, weight)
                for c in range(6):
                    by[c] = weight[0] * control[i, f, cell, c] + weight[1] * control[i, f, cell + 1, c]
                    by[c] += weight[2] * control[i, f, cell + 2, c] + weight[3] * control[i, f, cell + 3, c]
                bent_leg(directions[i, s], 3 * upper, 3 * lower, thigh, shank, by)
                turned_sole(directions[i, s], length_m[i], soles[f], by)
