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
    """Writes by how much an ankle (3, T) misses its moves (3 or more, T) after its leg is bent: see ``ankle_ways``.

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
def bends_at(control, place, by):
    """Bends by (6, S) at places (S,), in cells, of the spline with control points (T + 2, 6)."""
    weight = np.empty(4)
    for s in range(place.size):
        cell = min(int(place[s]), control.shape[0] - 4)
        spline_weights(place[s] - cell, weight)
        w0, w1, w2, w3 = weight[0], weight[1], weight[2], weight[3]
        for c in range(6):
            by[c, s] = w0 * control[cell, c] + w1 * control[cell + 1, c]
            by[c, s] += w2 * control[cell + 2, c] + w3 * control[cell + 3, c]


@compiled(error_model="numpy", nogil=True)
def ankle_ways(to, upper, lower, thigh, shank, by, knee, leg, ahead):
    """Where ankles are to be whose legs bend ``by`` (6, S), seen from the hip, and how far ahead their knees are.

    to (S, 3B) : directions; upper, lower : bones to knee and ankle, times 3; thigh, shank : their lengths
    knee (3, S) : where the knee is; leg (4, S) : unit vector to the ankle and how far it is; ahead (S,) : of the knee,
    in least ways ahead. A leg that is nearly straight keeps its length, one that is folded up keeps all of it.
    """
    full = thigh + shank
    share, shortest, longest = 1.0 / full, abs(thigh - shank) + 1e-4, STRAIGHT * full
    for s in range(ahead.size):
        a, b, c = thigh * to[s, upper], thigh * to[s, upper + 1], thigh * to[s, upper + 2]
        x, y, z = a + shank * to[s, lower], b + shank * to[s, lower + 1], c + shank * to[s, lower + 2]
        drawn = np.sqrt(x * x + y * y + z * z)
        follows, slack = unfolded(share * drawn), share * max(full - drawn, 0.0)
        x, y, z = x + follows * by[0, s], y + follows * by[1, s], z + follows * by[2, s]
        length = np.sqrt(x * x + y * y + z * z)
        less = 1.0 / max(length, 1e-12)
        x, y, z = x * less, y * less, z * less
        reach = drawn + (length - drawn) * slack / (slack + STIFF_KNEE)
        along = a * x + b * y + c * z
        knee[0, s], knee[1, s], knee[2, s] = a, b, c
        leg[0, s], leg[1, s], leg[2, s], leg[3, s] = x, y, z, min(max(reach, shortest), max(drawn, longest))
        ahead[s] = (a - along * x) / (np.sqrt(max(1.0 - x * x, 1e-12)) * AHEAD * full)


@compiled(error_model="numpy", nogil=True)
def bent_legs(to, upper, lower, thigh, shank, knee, leg, ahead):
    """Directions ``to`` (S, 3B) with a leg bent, in place, so that its ankle is where ``ankle_ways`` puts it."""
    full, to_knee, to_ankle = thigh + shank, 1.0 / thigh, 1.0 / shank
    for s in range(ahead.size):
        ahead[s] = 1.0 + soft_plus(ahead[s] - 1.0) - ahead[s]
    for s in range(ahead.size):
        x, y, z, reach = leg[0, s], leg[1, s], leg[2, s], leg[3, s]
        a, b, c = knee[0, s], knee[1, s], knee[2, s]
        level = max(1.0 - x * x, 1e-12)
        more = AHEAD * full * ahead[s] * unfolded(reach / full) * np.sqrt(level) / (level + SIDEWAYS)
        along = a * x + b * y + c * z + more * x
        a, b, c = a + more - along * x, b - along * y, c - along * z
        fore = (thigh**2 - shank**2 + reach**2) / (2.0 * reach)
        out = np.sqrt(max(thigh**2 - fore**2, 0.0)) / max(np.sqrt(a * a + b * b + c * c), 1e-9)
        a, b, c = fore * x + out * a, fore * y + out * b, fore * z + out * c
        to[s, upper], to[s, upper + 1], to[s, upper + 2] = to_knee * a, to_knee * b, to_knee * c
        to[s, lower], to[s, lower + 1] = to_ankle * (reach * x - a), to_ankle * (reach * y - b)
        to[s, lower + 2] = to_ankle * (reach * z - c)


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
def turned_soles(to, length_m, sole, by):
    """Directions ``to`` (S, 3B) with the bones of a foot turned, in place, so that its unit vector changes by[3:] (S).

    The least rotation that takes the one vector into the other.
    """
    if sole.size == 0 or sole[0] < 0:
        return
    for s in range(to.shape[0]):
        x, y, z = 0.0, 0.0, 0.0
        for bone in sole:
            if bone >= 0:
                x += length_m[bone] * to[s, 3 * bone]
                y += length_m[bone] * to[s, 3 * bone + 1]
                z += length_m[bone] * to[s, 3 * bone + 2]
        less = 1.0 / max(np.sqrt(x * x + y * y + z * z), 1e-12)
        x, y, z = less * x, less * y, less * z
        now_x, now_y, now_z = x + by[3, s], y + by[4, s], z + by[5, s]
        less = 1.0 / max(np.sqrt(now_x * now_x + now_y * now_y + now_z * now_z), 1e-12)
        now_x, now_y, now_z = less * now_x, less * now_y, less * now_z
        cosine = 1.0 + x * now_x + y * now_y + z * now_z
        if cosine < 1e-6:
            continue
        less, both_x, both_y, both_z = 1.0 / cosine, x + now_x, y + now_y, z + now_z
        for bone in sole:
            if bone < 0:
                break
            a, b, c = to[s, 3 * bone], to[s, 3 * bone + 1], to[s, 3 * bone + 2]
            first = 2.0 * (x * a + y * b + z * c)
            both = (both_x * a + both_y * b + both_z * c) * less
            to[s, 3 * bone] = a + first * now_x - both * both_x
            to[s, 3 * bone + 1] = b + first * now_y - both * both_y
            to[s, 3 * bone + 2] = c + first * now_z - both * both_z


@compiled(error_model="numpy", nogil=True)
def bent(directions, length_m, legs, soles, place, control):
    """Directions (n, S, 3B) with the legs bent, in place, so that ankles and feet move by what ``footed`` wants.

    legs (2, 2) : bones to knee and to ankle of each side; soles (2, K) : bones from ankle to toe, -1 for none more
    control (n, 2, T + 2, 6) : control points of the bends, at places (n, S), in cells
    Two bones: the lengths stay, the knee keeps to its side (the plane of hip, knee, ankle).
    NOTE: all frames of a leg step by step: frame by frame, each number waits for the one before (twice the time).
    """
    n_frames = place.shape[1]
    by, knee, leg, ahead = np.empty((6, n_frames)), np.empty((3, n_frames)), np.empty((4, n_frames)), np.empty(n_frames)
    for i in range(directions.shape[0]):
        for f in range(2):
            upper, lower = legs[f, 0], legs[f, 1]
            bones = 3 * upper, 3 * lower, length_m[i, upper], length_m[i, lower]
            bends_at(control[i, f], place[i], by)
            ankle_ways(directions[i], *bones, by, knee, leg, ahead)
            bent_legs(directions[i], *bones, knee, leg, ahead)
            turned_soles(directions[i], length_m[i], soles[f], by)
