"""Bodies that stand as somebody stood: the root moved until planted feet are where they belong, legs bent after it.

Its twin: planted in tests/naive_footing.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.bodies import stand
from emulator.kernels.compiled import compiled
from emulator.kernels.sphere import spline_weights

STRAIGHT = 0.9995
"""The most of its length to which a leg stretches."""
STIFF_KNEE, AHEAD = 0.01, 0.02
"""A leg straight to within this share of its length keeps its length, and a knee straight to within that bends ahead:
else a millimetre of a foot would throw the knee about by centimetres."""
FOLDED = (0.15, 0.35)
"""A leg whose ankle is this near to its hip, in leg lengths, turns about with every millimetre: it follows not at all
below the first, fully above the second."""
MOST_BEND_M = 0.12
"""What legs bend at most, softly: a foot that would have to go farther is where the draw's own posture has it."""
FRAME_S = (1.0 - 1e-9) / 30.0
"""Speeds are those between frames of a camera; a hair less, so that points which come at that rate are taken."""


@compiled(error_model="numpy", nogil=True)
def smooth(values, sigma, reach, out):
    """Gaussian means out (T,) of values (T,) with standard deviation sigma, in points; the ends are held."""
    n = values.size
    total = 1.0
    for k in range(1, reach + 1):
        total += 2.0 * np.exp(-0.5 * (k / sigma) ** 2)
    for t in range(n):
        mean = values[t]
        for k in range(1, reach + 1):
            mean += np.exp(-0.5 * (k / sigma) ** 2) * (values[max(t - k, 0)] + values[min(t + k, n - 1)])
        out[t] = mean / total


@compiled(error_model="numpy", nogil=True)
def raised(lacking, sigma, reach, out):
    """By how much, out (T,), something is raised that lacks heights (T,): by the most that lacks nearby, smoothly."""
    n = lacking.size
    nearby = np.empty(n)
    for t in range(n):
        nearby[t] = 0.0
        for k in range(max(t - reach, 0), min(t + reach + 1, n)):
            nearby[t] = max(nearby[t], lacking[k])
    smooth(nearby, sigma, reach, out)


@compiled(error_model="numpy", nogil=True)
def foot_moves(middle, standing, print_m, moves):
    """What brings a foot (T, 3) to where it belongs, into moves (T, 3); returns how many points it stands at all.

    standing (T,) : whether it stands; print_m (T, 3) : its level way about one place, and its height, while it stands
    The place of a stance is the median of where the foot is there. Between two stances the move of the one goes over
    into that of the other, smoothly to the second derivative; before the first and after the last it stays.
    """
    n = standing.size
    last, n_standing, t = -1, 0, 0
    moves[:] = 0.0
    while t < n:
        if not standing[t]:
            t += 1
            continue
        stop = t
        while stop < n and standing[stop]:
            stop += 1
        for c in range(3):
            place = np.median(middle[t:stop, c] - print_m[t:stop, c]) if c < 2 else 0.0
            for s in range(t, stop):
                moves[s, c] = place + print_m[s, c] - middle[s, c]
        for s in range(last + 1, t):
            u = (s - last) / (t - last)
            ease = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) if last >= 0 else 1.0
            for c in range(3):
                before = moves[last, c] if last >= 0 else 0.0
                moves[s, c] = before + ease * (moves[t, c] - before)
        n_standing += stop - t
        last = stop - 1
        t = stop
    for s in range(last + 1, n if last >= 0 else 0):
        for c in range(3):
            moves[s, c] = moves[last, c]
    return n_standing


@compiled(error_model="numpy", nogil=True)
def fastest_joint(bodies, time_s):
    """The greatest speed of any joint of bodies (T, J, 3) at times (T,) over ``FRAME_S``, or the next longer time."""
    most, late = 0.0, 0
    for t in range(time_s.size):
        while late < time_s.size - 1 and time_s[late] - time_s[t] < FRAME_S:
            late += 1
        step_s = time_s[late] - time_s[t]
        if step_s < FRAME_S:
            break
        for j in range(bodies.shape[1]):
            square = 0.0
            for c in range(3):
                square += (bodies[late, j, c] - bodies[t, j, c]) ** 2
            most = max(most, square / step_s**2)
    return np.sqrt(most)


@compiled(error_model="numpy", nogil=True)
def footed(directions, length_m, chain, feet, standing, prints, time_s, floor_m, foot_floor_m, path, bends, fastest):
    """Moves the root of path (n, T, 4) until feet stand; what legs must bend beyond that into bends (n, 2, T, 3).

    directions (n, T, 3B), length_m (n, B); feet (2, 2) : ankle and toe of each side
    standing (n, 2, T), prints (n, 2, T, 3) : as for ``foot_moves``, in the frame of the heading
    time_s (n, T) : when the points come; no joint below floor_m, none of the feet below foot_floor_m (n, 2, 2)
    bends are without heading, as ``directions``
    fastest (n,) : the greatest speed of a joint over ``FRAME_S`` or the next longer time between points, written here
    """
    n_times = path.shape[1]
    bodies = np.empty((n_times, chain.shape[0] + 1, 3))
    middle, print_m, lowest = np.empty((2, n_times, 3)), np.empty((n_times, 3)), np.empty(n_times)
    sunk = np.empty((2, n_times))
    moves, weight = np.empty((2, n_times, 3)), np.empty((2, n_times))
    raw, shift, lift, less_of = np.empty(n_times), np.empty((n_times, 3)), np.empty(n_times), np.empty(2)
    for i in range(path.shape[0]):
        for t in range(n_times):
            joints = bodies[t]
            for c in range(3):
                joints[chain[0, 1], c] = path[i, t, c]
            cosine, sine = np.cos(path[i, t, 3]), np.sin(path[i, t, 3])
            stand(directions[i, t], length_m[i], chain, cosine, sine, joints)
            lowest[t] = np.inf
            for j in range(joints.shape[0]):
                lowest[t] = min(lowest[t], joints[j, 2])
            for f in range(2):
                for c in range(3):
                    middle[f, t, c] = 0.5 * (joints[feet[f, 0], c] + joints[feet[f, 1], c])
                sunk[f, t] = -np.inf
                for k in range(2):
                    sunk[f, t] = max(sunk[f, t], foot_floor_m[i, f, k] - joints[feet[f, k], 2])
        point_s = time_s[i, n_times - 1] / (n_times - 1)
        wide, narrow = max(0.08 / point_s, 0.3), max(0.06 / point_s, 0.3)
        reach = int(4 * narrow) + 1
        n_standing = 0
        for f in range(2):
            for t in range(n_times):
                cosine, sine = np.cos(path[i, t, 3]), np.sin(path[i, t, 3])
                x, y = prints[i, f, t, 0], prints[i, f, t, 1]
                print_m[t, 0], print_m[t, 1] = cosine * x - sine * y, sine * x + cosine * y
                print_m[t, 2] = prints[i, f, t, 2]
                raw[t] = (1.0 if standing[i, f, t] else 0.0) + 1e-3
            own = foot_moves(middle[f], standing[i, f], print_m, moves[f])
            n_standing += own
            if own > 0:
                for t in range(n_times):
                    sunk[f, t] -= moves[f, t, 2]
                raised(sunk[f], narrow, reach, lift)
                moves[f, :, 2] += lift
            smooth(raw, wide, int(4 * wide) + 1, weight[f])
            if own == 0:
                weight[f] = 0.0
        for c in range(3):
            for t in range(n_times):
                total = weight[0, t] + weight[1, t]
                mean = weight[0, t] * moves[0, t, c] + weight[1, t] * moves[1, t, c]
                raw[t] = mean / total if n_standing > 0 else 0.0
            smooth(raw, narrow, int(4 * narrow) + 1, shift[:, c])
        for t in range(n_times):
            lowest[t] = floor_m - lowest[t] - shift[t, 2]
        raised(lowest, narrow, reach, lift)
        for t in range(n_times):
            shift[t, 2] += lift[t]
            cosine, sine = np.cos(path[i, t, 3]), np.sin(path[i, t, 3])
            for f in range(2):
                x, y = moves[f, t, 0] - shift[t, 0], moves[f, t, 1] - shift[t, 1]
                z = moves[f, t, 2] - shift[t, 2]
                far = np.sqrt(x * x + y * y + z * z) / MOST_BEND_M
                less = 0.0 if weight[f, t] == 0.0 else (np.tanh(far) / far if far > 1e-6 else 1.0)
                less_of[f] = less
                x, y, z = less * x, less * y, less * z
                bends[i, f, t, 0], bends[i, f, t, 1], bends[i, f, t, 2] = (
                    cosine * x + sine * y,
                    cosine * y - sine * x,
                    z,
                )
            for c in range(3):
                path[i, t, c] += shift[t, c]
                for j in range(bodies.shape[1]):
                    bodies[t, j, c] += shift[t, c]
                for f in range(2 if n_standing > 0 else 0):
                    for j in feet[f]:
                        bodies[t, j, c] += less_of[f] * (moves[f, t, c] - shift[t, c])
        fastest[i] = fastest_joint(bodies, time_s[i])


@compiled(error_model="numpy", nogil=True)
def bent(directions, length_m, legs, place, control):
    """Directions (n, S, 3B) with the legs bent, in place, so that ankles move by what ``footed`` wants.

    legs (2, 2) : bones to knee and to ankle of each side; control (n, 2, T + 2, 3) control points of the bends at
    places (n, S), in cells. Two bones: the lengths stay, the knee keeps to its side (the plane of hip, knee, ankle).
    """
    leg, knee, weight = np.empty(3), np.empty(3), np.empty(4)
    for i in range(directions.shape[0]):
        for f in range(2):
            upper, lower = legs[f, 0], legs[f, 1]
            thigh, shank = length_m[i, upper], length_m[i, lower]
            for s in range(place.shape[1]):
                cell = min(int(place[i, s]), control.shape[2] - 4)
                spline_weights(place[i, s] - cell, weight)
                to = directions[i, s]
                length, drawn, full = 0.0, 0.0, thigh + shank
                for c in range(3):
                    knee[c] = thigh * to[3 * upper + c]
                    leg[c] = knee[c] + shank * to[3 * lower + c]
                    drawn += leg[c] ** 2
                drawn = np.sqrt(drawn)
                u = min(max((drawn / full - FOLDED[0]) / (FOLDED[1] - FOLDED[0]), 0.0), 1.0)
                follows = u * u * (3.0 - 2.0 * u)
                for c in range(3):
                    for k in range(4):
                        leg[c] += follows * weight[k] * control[i, f, cell + k, c]
                    length += leg[c] ** 2
                length = np.sqrt(length)
                slack = max(full - drawn, 0.0) / full
                reach = drawn + (length - drawn) * slack / (slack + STIFF_KNEE)
                reach = min(max(reach, abs(thigh - shank) + 1e-4), max(drawn, STRAIGHT * full))
                fore = (thigh**2 - shank**2 + reach**2) / (2.0 * reach)
                along = 0.0
                for c in range(3):
                    leg[c] /= max(length, 1e-12)
                    along += knee[c] * leg[c]
                size = 0.0
                for c in range(3):
                    ahead = (1.0 if c == 0 else 0.0) - leg[0] * leg[c]
                    knee[c] += AHEAD * full * ahead - along * leg[c]
                    size += knee[c] ** 2
                out = np.sqrt(max(thigh**2 - fore**2, 0.0)) / max(np.sqrt(size), 1e-9)
                for c in range(3):
                    joint = fore * leg[c] + out * knee[c]
                    to[3 * upper + c] = joint / thigh
                    to[3 * lower + c] = (reach * leg[c] - joint) / shank
