"""Bodies that stand as somebody stood: the root moved until planted feet are where they belong, legs bent after it.

Its twin: planted in tests/naive/footing.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.bodies import stand
from emulator.kernels.compiled import compiled
from emulator.kernels.legs import bend_of, left_over, turned_foot

SETTLING = 3
"""So often the root follows what its legs are too straight or too short to do."""
FRAME_S = (1.0 - 1e-9) / 30.0
"""Speeds are those between frames of a camera; a hair less, so that points which come at that rate are taken."""


@compiled(error_model="numpy", nogil=True)
def smooth(values, sigma, reach, out):
    """Gaussian means out (T,) of values (T,) with standard deviation sigma, in points; the ends are held."""
    n = values.size
    held = np.empty(n + 2 * reach)
    held[:reach], held[reach : reach + n], held[reach + n :] = values[0], values, values[n - 1]
    out[:] = values
    total = 1.0
    for k in range(1, reach + 1):
        weight = np.exp(-0.5 * (k / sigma) ** 2)
        total += 2.0 * weight
        early, late = held[reach - k : reach - k + n], held[reach + k : reach + k + n]
        for t in range(n):  # NOTE: points inside: each step is the same for all, and goes four at a time
            out[t] += weight * (early[t] + late[t])
    for t in range(n):
        out[t] /= total


@compiled(error_model="numpy", nogil=True)
def raised(lacking, sigma, reach, out):
    """By how much, out (T,), something is raised that lacks heights (T,): by the most that lacks nearby, smoothly."""
    n, most = lacking.size, 0.0
    for t in range(n):
        most = max(most, lacking[t])
    if most <= 0.0:
        out[:] = 0.0
        return
    nearby = np.empty(n)
    for t in range(n):
        nearby[t] = 0.0
        for k in range(max(t - reach, 0), min(t + reach + 1, n)):
            nearby[t] = max(nearby[t], lacking[k])
    smooth(nearby, sigma, reach, out)


@compiled(error_model="numpy", nogil=True)
def stance_end(standing, start):
    """One beyond the last point of the stance that begins at ``start``."""
    stop = start
    while stop < standing.size and standing[stop]:
        stop += 1
    return stop


@compiled(error_model="numpy", nogil=True)
def bridged(standing, moves):
    """What is known in stances, moves (T, C), between them too, in place; returns how many points stand at all.

    Between two stances the move of the one goes over into that of the other, smoothly to the second derivative; before
    the first and after the last it stays.
    """
    n = standing.size
    last, n_standing, t = -1, 0, 0
    while t < n:
        if not standing[t]:
            t += 1
            continue
        for s in range(last + 1, t):
            u = (s - last) / (t - last)
            ease = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u) if last >= 0 else 1.0
            for c in range(moves.shape[1]):
                before = moves[last, c] if last >= 0 else 0.0
                moves[s, c] = before + ease * (moves[t, c] - before)
        stop = stance_end(standing, t)
        n_standing += stop - t
        last, t = stop - 1, stop
    for s in range(last + 1, n if last >= 0 else 0):
        for c in range(moves.shape[1]):
            moves[s, c] = moves[last, c]
    return n_standing


@compiled(error_model="numpy", nogil=True)
def point(way_rad, pitch_rad, out):
    """Writes the unit vector (3,) to a side seen from above, so far up."""
    level = np.cos(pitch_rad)
    out[0], out[1], out[2] = level * np.cos(way_rad), level * np.sin(way_rad), np.sin(pitch_rad)


@compiled(error_model="numpy", nogil=True)
def foot_moves(middle, toward, standing, prints, cosine, sine, moves):
    """What brings a foot to where it belongs, into moves (T, 6): of its middle (T, 3), of where it points (T, 3).

    standing (T,) : whether it stands; cosine, sine (T,) : of the heading
    prints (T, 3 or 5) : its level way about one place in the frame of the heading and its height, while it stands;
        and the way in which it points to its toe about one way, and how far up, in radians; without these it points
        to where it pointed
    The place of a stance is the median of where the foot is there, its direction that which turns least. Returns how
    many points it stands at all.
    """
    n, t = standing.size, 0
    moves[:] = 0.0
    while t < n:
        if not standing[t]:
            t += 1
            continue
        stop = stance_end(standing, t)
        for s in range(t, stop):
            x, y = prints[s, 0], prints[s, 1]
            moves[s, 0] = cosine[s] * x - sine[s] * y - middle[s, 0]
            moves[s, 1] = sine[s] * x + cosine[s] * y - middle[s, 1]
            moves[s, 2] = prints[s, 2] - middle[s, 2]
        for c in range(2):
            moves[t:stop, c] -= np.median(moves[t:stop, c])
        if prints.shape[1] == 5:
            along, across = 0.0, 0.0
            for s in range(t, stop):
                point(prints[s, 3], prints[s, 4], moves[s, 3:])
                along += moves[s, 3] * toward[s, 0] + moves[s, 4] * toward[s, 1]
                across += moves[s, 3] * toward[s, 1] - moves[s, 4] * toward[s, 0]
            size = max(np.hypot(along, across), 1e-300)
            along, across = along / size, across / size
            for s in range(t, stop):
                x, y = moves[s, 3], moves[s, 4]
                moves[s, 3] = along * x - across * y - toward[s, 0]
                moves[s, 4] = across * x + along * y - toward[s, 1]
                moves[s, 5] -= toward[s, 2]
        t = stop
    return bridged(standing, moves)


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
def mean_move(moves, weight, sigma, raw, out):
    """Writes the smooth mean out (T, 3) of the moves (2, T, 3 or more) of two feet by their weights (2, T)."""
    n = weight.shape[1]
    for c in range(3):
        for t in range(n):
            mean = weight[0, t] * moves[0, t, c] + weight[1, t] * moves[1, t, c]
            raw[t] = mean / (weight[0, t] + weight[1, t])
        smooth(raw, sigma, int(4 * sigma) + 1, out[:, c])


@compiled(error_model="numpy", nogil=True)
def carrying(standing, point_s, raw, weight):
    """How much each foot carries, weight (2, T), that stands where standing (2, T) says; points point_s apart."""
    wide = max(0.08 / point_s, 0.3)
    for f in range(2):
        ever = False
        for t in range(standing.shape[1]):
            raw[t] = (1.0 if standing[f, t] else 0.0) + 1e-3
            ever = ever or standing[f, t]
        smooth(raw, wide, int(4 * wide) + 1, weight[f])
        if not ever:
            weight[f] = 0.0


@compiled(error_model="numpy", nogil=True)
def off_feet(centre, place, weight, out):
    """The way out (2,) to a centre of mass from the nearest place between two feet, seen from above; returns how far.

    place (2, 2) : the middles of the feet, weight (2,) : how much each carries; one that carries little is drawn in
    """
    total = max(weight[0] + weight[1], 1e-300)
    along, square = 0.0, 1e-12
    for c in range(2):
        out[c] = centre[c] - (weight[0] * place[0, c] + weight[1] * place[1, c]) / total
        way = place[1, c] - place[0, c]
        along += out[c] * way
        square += way * way
    less = min(2.0 * weight[0], 2.0 * weight[1], total) / total
    share = min(max(along / square, -less * weight[1] / total), less * weight[0] / total)
    for c in range(2):
        out[c] -= share * (place[1, c] - place[0, c])
    return np.sqrt(out[0] ** 2 + out[1] ** 2)


@compiled(error_model="numpy", nogil=True)
def strayed(centres, places, weight, out):
    """How far each centre of mass (T, 2) is from between the feet, places (2, T, 2), out (T,); see ``off_feet``."""
    way = np.empty(2)
    for t in range(out.size):
        out[t] = off_feet(centres[t], places[:, t], weight[:, t], way)


@compiled(error_model="numpy", nogil=True)
def held_up(bodies, mass, places, weight, stray_m, out):
    """By how much a body is to move, out (T, 3), level, to be no farther off its feet than stray_m (T,).

    bodies (T, J, 3); mass (J,) : shares of the joints in the centre of mass; places, weight : as for ``strayed``
    """
    centre = np.empty(2)
    for t in range(stray_m.size):
        centre[:] = 0.0
        for j in range(mass.size):
            for c in range(2):
                centre[c] += mass[j] * bodies[t, j, c]
        far = off_feet(centre, places[:, t], weight[:, t], out[t])
        for c in range(2):
            out[t, c] *= -max(far - stray_m[t], 0.0) / max(far, 1e-12)
        out[t, 2] = 0.0


@compiled(error_model="numpy", nogil=True)
def footed(
    directions,
    length_m,
    chain,
    feet,
    legs,
    standing,
    prints,
    time_s,
    floor_m,
    foot_floor_m,
    mass,
    stray_m,
    path,
    bends,
    fastest,
):
    """Moves the root of path (n, T, 4) until feet stand; what legs must bend beyond that into bends (n, 2, T, 6).

    directions (n, T, 3B), length_m (n, B); feet (2, 2) : ankle and toe of each side; legs (2, 2 or 0) : as for ``bent``
    standing (n, 2, T), prints (n, 2, T, 3 or 5) : as for ``foot_moves``
    time_s (n, T) : when the points come; no joint below floor_m (n,), none of the feet below foot_floor_m (n, 2, 2)
    mass (J,), stray_m (n, T) : as for ``held_up``
    bends : of the ankle and of the unit vector from ankle to toe, without heading, as ``directions``
    fastest (n,) : the greatest speed of a joint over ``FRAME_S`` or the next longer time between points, written here
    """
    n_times = path.shape[1]
    bodies = np.empty((n_times, chain.shape[0] + 1, 3))
    middle, lowest, sunk = np.empty((n_times, 3)), np.empty(n_times), np.empty(n_times)
    cosine, sine = np.empty(n_times), np.empty(n_times)
    toward, foot_m = np.empty((2, n_times, 3)), np.empty((2, n_times))
    moves, weight = np.empty((2, n_times, 6)), np.empty((2, n_times))
    left, more, place = np.empty((2, n_times, 3)), np.empty((n_times, 3)), np.empty((2, n_times, 2))
    raw, shift, lift, foot = np.empty(n_times), np.empty((n_times, 3)), np.empty(n_times), np.empty(3)
    by, leg = np.empty(6), np.empty(3)
    for i in range(path.shape[0]):
        for t in range(n_times):
            joints = bodies[t]
            for c in range(3):
                joints[chain[0, 1], c] = path[i, t, c]
            cosine[t], sine[t] = np.cos(path[i, t, 3]), np.sin(path[i, t, 3])
            stand(directions[i, t], length_m[i], chain, cosine[t], sine[t], joints)
            lowest[t] = np.inf
            for j in range(joints.shape[0]):
                lowest[t] = min(lowest[t], joints[j, 2])
        point_s = time_s[i, n_times - 1] / (n_times - 1)
        narrow = max(0.06 / point_s, 0.3)
        reach = int(4 * narrow) + 1
        n_standing = 0
        carrying(standing[i], point_s, raw, weight)
        for f in range(2):
            for t in range(n_times):
                ankle, toe, square = bodies[t, feet[f, 0]], bodies[t, feet[f, 1]], 0.0
                for c in range(3):
                    middle[t, c] = 0.5 * (ankle[c] + toe[c])
                    square += (toe[c] - ankle[c]) ** 2
                foot_m[f, t] = max(np.sqrt(square), 1e-12)
                for c in range(3):
                    toward[f, t, c] = (toe[c] - ankle[c]) / foot_m[f, t]
            own = foot_moves(middle, toward[f], standing[i, f], prints[i, f], cosine, sine, moves[f])
            n_standing += own
            for t in range(n_times):
                turned_foot(toward[f, t], moves[f, t, 3:], foot)
                for c in range(3):
                    moves[f, t, 3 + c] = foot[c] - toward[f, t, c]
                    moves[f, t, c] -= 0.5 * foot_m[f, t] * moves[f, t, 3 + c]
                ankle_m = bodies[t, feet[f, 0], 2] + moves[f, t, 2]
                sunk[t] = max(foot_floor_m[i, f, 0], foot_floor_m[i, f, 1] - foot_m[f, t] * foot[2]) - ankle_m
            if own > 0:
                raised(sunk, narrow, reach, lift)
                moves[f, :, 2] += lift
        shift[:] = 0.0
        if n_standing > 0:
            mean_move(moves, weight, narrow, raw, shift)
            for f in range(2):
                moves[f, :, :3] -= shift
        for _ in range(SETTLING if n_standing > 0 and legs.shape[1] == 2 else 0):
            for f in range(2):
                for t in range(n_times):
                    left_over(
                        directions[i, t], length_m[i], legs[f], moves[f, t], cosine[t], sine[t], by, leg, left[f, t]
                    )
            mean_move(left, weight, narrow, raw, more)
            shift += more
            for f in range(2):
                moves[f, :, :3] -= more
        if n_standing > 0 and legs.shape[1] == 2 and mass.size > 0:
            for t in range(n_times):
                for f in range(2):
                    for c in range(2):
                        half = 0.5 * foot_m[f, t] * (toward[f, t, c] + moves[f, t, 3 + c])
                        place[f, t, c] = bodies[t, feet[f, 0], c] + moves[f, t, c] + half
            held_up(bodies, mass, place, weight, stray_m[i], more)
            for c in range(2):
                smooth(more[:, c], narrow, reach, raw)
                shift[:, c] += raw
                for f in range(2):
                    moves[f, :, c] -= raw
        for t in range(n_times):
            lowest[t] = floor_m[i] - lowest[t] - shift[t, 2]
            for f in range(2 if n_standing > 0 and legs.shape[1] == 2 else 0):
                left_over(directions[i, t], length_m[i], legs[f], moves[f, t], cosine[t], sine[t], by, leg, foot)
                ankle_m = bodies[t, feet[f, 0], 2] + shift[t, 2] + moves[f, t, 2] - foot[2]
                toe_m = ankle_m + foot_m[f, t] * (toward[f, t, 2] + moves[f, t, 5])
                lowest[t] = max(lowest[t], foot_floor_m[i, f, 0] - ankle_m, foot_floor_m[i, f, 1] - toe_m)
        raised(lowest, narrow, reach, lift)
        for t in range(n_times):
            shift[t, 2] += lift[t]
            for c in range(3):
                path[i, t, c] += shift[t, c]
                for j in range(bodies.shape[1]):
                    bodies[t, j, c] += shift[t, c]
            for f in range(2):
                moves[f, t, 2] -= lift[t]
                bends[i, f, t] = 0.0
                if weight[f, t] > 0.0:
                    bend_of(moves[f, t], cosine[t], sine[t], bends[i, f, t])
                    for c in range(3):
                        bodies[t, feet[f, 0], c] += moves[f, t, c]
                        bodies[t, feet[f, 1], c] += moves[f, t, c] + foot_m[f, t] * moves[f, t, 3 + c]
        fastest[i] = fastest_joint(bodies, time_s[i])
