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
MOST_BEND_M = 0.2
"""What legs bend at most, softly: a foot that would have to go farther is where the draw's own posture has it."""


@compiled(error_model="numpy", nogil=True)
def bend_of(move, cosine, sine, out):
    """What a leg must bend and its foot turn, out (6,), without heading, for a move (6,) in the frame of the path."""
    far = np.sqrt(move[0] ** 2 + move[1] ** 2 + move[2] ** 2) / MOST_BEND_M
    less = 1.0 / np.sqrt(np.sqrt(1.0 + far**4))
    for k in range(0, 6, 3):
        by = less if k == 0 else 1.0
        out[k] = by * (cosine * move[k] + sine * move[k + 1])
        out[k + 1] = by * (cosine * move[k + 1] - sine * move[k])
        out[k + 2] = by * move[k + 2]


@compiled(error_model="numpy", nogil=True)
def unfolded(share):
    """From 0 to 1 as the distance of hip and ankle, as a share of the leg, goes through ``FOLDED``."""
    u = min(max((share - FOLDED[0]) / (FOLDED[1] - FOLDED[0]), 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)


@compiled(error_model="numpy", nogil=True)
def leg_after(to, length_m, leg_bones, by, leg):
    """Writes the unit vector (3,) from hip to ankle of a leg whose ankle is to move ``by`` (3,); returns how long.

    to (3B,) : directions; a leg that is nearly straight keeps its length, one that is folded up keeps all of it
    """
    upper, lower = leg_bones
    thigh, shank = length_m[upper], length_m[lower]
    length, drawn, full = 0.0, 0.0, thigh + shank
    for c in range(3):
        leg[c] = thigh * to[3 * upper + c] + shank * to[3 * lower + c]
        drawn += leg[c] ** 2
    drawn = np.sqrt(drawn)
    follows = unfolded(drawn / full)
    for c in range(3):
        leg[c] += follows * by[c]
        length += leg[c] ** 2
    length = np.sqrt(length)
    for c in range(3):
        leg[c] /= max(length, 1e-12)
    slack = max(full - drawn, 0.0) / full
    reach = drawn + (length - drawn) * slack / (slack + STIFF_KNEE)
    return min(max(reach, abs(thigh - shank) + 1e-4), max(drawn, STRAIGHT * full))


@compiled(error_model="numpy", nogil=True)
def left_over(to, length_m, leg_bones, move, cosine, sine, by, leg, left):
    """Writes by how much an ankle (3,) misses its move (3,) after the leg of directions ``to`` (3B,) is bent.

    by (6,), leg (3,) : room to work in
    """
    bend_of(move, cosine, sine, by)
    reach = leg_after(to, length_m, leg_bones, by, leg)
    for c in range(3):
        leg[c] = reach * leg[c]
        for k in range(2):
            bone = leg_bones[k]
            leg[c] -= length_m[bone] * to[3 * bone + c]
    left[0] = move[0] - (cosine * leg[0] - sine * leg[1])
    left[1] = move[1] - (sine * leg[0] + cosine * leg[1])
    left[2] = move[2] - leg[2]


@compiled(error_model="numpy", nogil=True)
def soft_plus(x):
    """log(1 + exp(x))."""
    return max(x, 0.0) + np.log1p(np.exp(-abs(x)))


@compiled(error_model="numpy", nogil=True)
def bent_leg(to, length_m, leg_bones, by, leg, knee):
    """Directions ``to`` (3B,) with a leg bent, in place, so that its ankle moves ``by`` (3,); leg, knee (3,) : room."""
    upper, lower = leg_bones
    thigh, shank = length_m[upper], length_m[lower]
    reach = leg_after(to, length_m, leg_bones, by, leg)
    fore = (thigh**2 - shank**2 + reach**2) / (2.0 * reach)
    along = 0.0
    for c in range(3):
        knee[c] = thigh * to[3 * upper + c]
        along += knee[c] * leg[c]
    size, level = 0.0, max(1.0 - leg[0] ** 2, 1e-12)
    least = AHEAD * (thigh + shank)
    ahead = (knee[0] - along * leg[0]) / np.sqrt(level)
    want = least + least * soft_plus(ahead / least - 1.0)
    more = (want - ahead) * unfolded(reach / (thigh + shank)) * np.sqrt(level) / (level + SIDEWAYS)
    for c in range(3):
        knee[c] += more * ((1.0 if c == 0 else 0.0) - leg[0] * leg[c]) - along * leg[c]
        size += knee[c] ** 2
    out = np.sqrt(max(thigh**2 - fore**2, 0.0)) / max(np.sqrt(size), 1e-9)
    for c in range(3):
        joint = fore * leg[c] + out * knee[c]
        to[3 * upper + c] = joint / thigh
        to[3 * lower + c] = (reach * leg[c] - joint) / shank


@compiled(error_model="numpy", nogil=True)
def turned_foot(toward, turn, out):
    """The unit vector out (3,) of a foot that pointed ``toward`` (3,), after its ``turn`` (3,)."""
    size = 0.0
    for c in range(3):
        out[c] = toward[c] + turn[c]
        size += out[c] ** 2
    size = max(np.sqrt(size), 1e-12)
    for c in range(3):
        out[c] /= size


@compiled(error_model="numpy", nogil=True)
def turned_sole(to, length_m, sole, by, was, foot):
    """Directions ``to`` (3B,) with the bones of a foot turned, in place, so that its unit vector changes ``by`` (3,).

    The least rotation that takes the one vector into the other. was, foot (3,) : room to work in
    """
    if sole.size == 0 or sole[0] < 0:
        return
    for c in range(3):
        was[c] = 0.0
    for bone in sole:
        for c in range(3 if bone >= 0 else 0):
            was[c] += length_m[bone] * to[3 * bone + c]
    size = 0.0
    for c in range(3):
        size += was[c] ** 2
    size = max(np.sqrt(size), 1e-12)
    for c in range(3):
        was[c] /= size
    turned_foot(was, by, foot)
    cosine = 1.0
    for c in range(3):
        cosine += was[c] * foot[c]
    if cosine < 1e-6:
        return
    for bone in sole:
        if bone < 0:
            break
        both, first = 0.0, 0.0
        for c in range(3):
            both += (was[c] + foot[c]) * to[3 * bone + c]
            first += was[c] * to[3 * bone + c]
        for c in range(3):
            to[3 * bone + c] += 2.0 * first * foot[c] - both / cosine * (was[c] + foot[c])


@compiled(error_model="numpy", nogil=True)
def bent(directions, length_m, legs, soles, place, control):
    """Directions (n, S, 3B) with the legs bent, in place, so that ankles and feet move by what ``footed`` wants.

    legs (2, 2) : bones to knee and to ankle of each side; soles (2, K) : bones from ankle to toe, -1 for none more
    control (n, 2, T + 2, 6) : control points of the bends, at places (n, S), in cells
    Two bones: the lengths stay, the knee keeps to its side (the plane of hip, knee, ankle).
    """
    by, weight, room = np.empty(6), np.empty(4), np.empty((4, 3))
    for i in range(directions.shape[0]):
        for f in range(2):
            for s in range(place.shape[1]):
                cell = min(int(place[i, s]), control.shape[2] - 4)
                spline_weights(place[i, s] - cell, weight)
                for c in range(6):
                    by[c] = 0.0
                    for k in range(4):
                        by[c] += weight[k] * control[i, f, cell + k, c]
                bent_leg(directions[i, s], length_m[i], legs[f], by, room[0], room[1])
                turned_sole(directions[i, s], length_m[i], soles[f], by[3:], room[2], room[3])
