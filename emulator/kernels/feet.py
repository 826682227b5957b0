"""Bodies that stand as somebody stood: the root moved until planted feet are where they belong, legs bent after it.

Its twin: planted in tests/naive/footing.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.balance import held_up
from emulator.kernels.bodies import stand
from emulator.kernels.compiled import compiled
from emulator.kernels.legs import bend_of, hip_to_ankle, left_over, turned_height

SETTLING = BALANCING = 3
"""So often the root follows what its legs are too straight or too short to do, and moves over the feet."""
ROOT_S, FEET_S = 0.15, 0.06
"""Standard deviations of the Gaussians that smooth what the root does for feet and balance, and what lifts a foot or a
body. A root that follows more closely shakes all above it wherever a drawn foot comes to stand or leaves."""
CARRY_S = 0.08
"""And of the one by which a foot takes over what it carries."""
FRAME_S = (1.0 - 1e-9) / 30.0
"""Speeds are those between frames of a camera; a hair less, so that points which come at that rate are taken."""
MOST = {"nnan", "nsz", "contract"}
"""What lets the greatest of many be found in lanes: that none of them is NaN."""


@compiled(error_model="numpy", nogil=True)
def bell(sigma):
    """Weights (R + 1,) of a Gaussian of standard deviation sigma, in points, at 0 to R points; both sides add to 1."""
    weight = np.empty(int(4 * sigma) + 2)
    total = -1.0
    for k in range(weight.size):
        weight[k] = np.exp(-0.5 * (k / sigma) ** 2)
        total += 2.0 * weight[k]
    for k in range(weight.size):
        weight[k] /= total
    return weight


@compiled(error_model="numpy", nogil=True)
def smooth(values, weight, out):
    """Means out (T,) of values (T,) by the weights (R + 1,) of 0 to R points; the ends are held."""
    n, reach = values.size, weight.size - 1
    held = np.empty(n + 2 * reach)
    held[:reach], held[reach : reach + n], held[reach + n :] = values[0], values, values[n - 1]
    for t in range(n):
        out[t] = weight[0] * values[t]
    for k in range(1, reach + 1):
        by, early, late = weight[k], held[reach - k : reach - k + n], held[reach + k : reach + k + n]
        for t in range(n):  # NOTE: points inside: each step is the same for all, and goes four at a time
            out[t] += by * (early[t] + late[t])


@compiled(error_model="numpy", nogil=True)
def raised(lacking, weight, out):
    """By how much, out (T,), something is raised that lacks heights (T,): by the most that lacks nearby, smoothly.

    weight (R + 1,) as for ``smooth``. Returns whether it is raised at all.
    """
    n, reach, most = lacking.size, weight.size - 1, 0.0
    for t in range(n):
        most = max(most, lacking[t])
    if most <= 0.0:
        out[:] = 0.0
        return False
    held, nearby = np.zeros(n + 2 * reach), np.zeros(n)
    held[reach : reach + n] = lacking
    for k in range(2 * reach + 1):
        late = held[k : k + n]
        for t in range(n):
            nearby[t] = max(nearby[t], late[t])
    smooth(nearby, weight, out)
    return True


@compiled(error_model="numpy", nogil=True)
def stance_end(standing, start):
    """One beyond the last point of the stance that begins at ``start``."""
    stop = start
    while stop < standing.size and standing[stop]:
        stop += 1
    return stop


@compiled(error_model="numpy", nogil=True)
def bridged(standing, moves):
    """What is known in stances, moves (C, T), between them too, in place; returns how many points stand at all.

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
            for c in range(moves.shape[0]):
                before = moves[c, last] if last >= 0 else 0.0
                moves[c, s] = before + ease * (moves[c, t] - before)
        stop = stance_end(standing, t)
        n_standing += stop - t
        last, t = stop - 1, stop
    for c in range(moves.shape[0] if last >= 0 else 0):
        moves[c, last + 1 :] = moves[c, last]
    return n_standing


@compiled(error_model="numpy", nogil=True)
def foot_moves(middle, toward, standing, prints, cosine, sine, moves):
    """What brings a foot to where it belongs, into moves (6, T): of its middle (3, T), of where it points (3, T).

    standing (T,) : whether it stands; cosine, sine (T,) : of the heading
    prints (T, 3 or 6) : its level way about one place in the frame of the heading and its height, while it stands;
        and the unit vector to its toe, turned to one way; without these it points to where it pointed
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
            moves[0, s] = cosine[s] * x - sine[s] * y - middle[0, s]
            moves[1, s] = sine[s] * x + cosine[s] * y - middle[1, s]
            moves[2, s] = prints[s, 2] - middle[2, s]
        for c in range(2):
            place = np.median(moves[c, t:stop])
            for s in range(t, stop):
                moves[c, s] -= place
        if prints.shape[1] == 6:
            along, across = 0.0, 0.0
            for s in range(t, stop):
                along += prints[s, 3] * toward[0, s] + prints[s, 4] * toward[1, s]
                across += prints[s, 3] * toward[1, s] - prints[s, 4] * toward[0, s]
            size = max(np.hypot(along, across), 1e-300)
            along, across = along / size, across / size
            for s in range(t, stop):
                x, y = prints[s, 3], prints[s, 4]
                moves[3, s] = along * x - across * y - toward[0, s]
                moves[4, s] = across * x + along * y - toward[1, s]
                moves[5, s] = prints[s, 5] - toward[2, s]
        t = stop
    return bridged(standing, moves)


@compiled(fastmath=MOST, error_model="numpy", nogil=True)
def most_apart(one, other, x, y, z):
    """The greatest square of how far apart joints (J, 3) are of one body and of another that is moved by x, y, z."""
    most = 0.0
    for j in range(one.shape[0]):
        a, b, c = other[j, 0] - one[j, 0] + x, other[j, 1] - one[j, 1] + y, other[j, 2] - one[j, 2] + z
        most = max(most, a * a + b * b + c * c)
    return most


@compiled(error_model="numpy", nogil=True)
def fastest_joint(bodies, shift, time_s):
    """The greatest speed of any joint of bodies (T, J, 3) at times (T,) over ``FRAME_S``, or the next longer time.

    shift (3, T) : by how much all of a body is to be moved
    """
    most, late = 0.0, 0
    for t in range(time_s.size):
        while late < time_s.size - 1 and time_s[late] - time_s[t] < FRAME_S:
            late += 1
        step_s = time_s[late] - time_s[t]
        if step_s < FRAME_S:
            break
        x, y, z = shift[0, late] - shift[0, t], shift[1, late] - shift[1, t], shift[2, late] - shift[2, t]
        most = max(most, most_apart(bodies[t], bodies[late], x, y, z) / step_s**2)
    return np.sqrt(most)


@compiled(error_model="numpy", nogil=True)
def mean_move(moves, weight, slow, raw, out):
    """Writes the smooth mean out (3, T) of the moves (2, 3 or more, T) of two feet by their weights (2, T)."""
    for c in range(3):
        for t in range(raw.size):
            mean = weight[0, t] * moves[0, c, t] + weight[1, t] * moves[1, c, t]
            raw[t] = mean / (weight[0, t] + weight[1, t])
        smooth(raw, slow, out[c])


@compiled(error_model="numpy", nogil=True)
def add(out, by, more):
    """Adds ``by`` times more (C, T) to the first rows of out (C or more, T)."""
    for c in range(more.shape[0]):
        for t in range(more.shape[1]):
            out[c, t] += by * more[c, t]


@compiled(error_model="numpy", nogil=True)
def carrying(standing, point_s, raw, weight):
    """How much each foot carries, weight (2, T), that stands where standing (2, T) says; points point_s apart."""
    wide = bell(max(CARRY_S / point_s, 0.3))
    for f in range(2):
        ever, always = False, True
        for t in range(standing.shape[1]):
            raw[t] = (1.0 if standing[f, t] else 0.0) + 1e-3
            ever, always = ever or standing[f, t], always and standing[f, t]
        if ever and not always:
            smooth(raw, wide, weight[f])
        else:
            weight[f] = raw[0] if ever else 0.0


@compiled(fastmath=MOST, error_model="numpy", nogil=True)
def lowest_of(joints):
    """The height of the lowest of joints (J, 3)."""
    low = np.inf
    for j in range(joints.shape[0]):
        low = min(low, joints[j, 2])
    return low


@compiled(error_model="numpy", nogil=True)
def hung(directions, length_m, chain, path, cosine, sine, bodies, lowest):
    """Bodies (T, J, 3) hung from their path (T, 4), cosine and sine (T,) of their heading, heights lowest (T,)."""
    for t in range(lowest.size):
        joints = bodies[t]
        for c in range(3):
            joints[chain[0, 1], c] = path[t, c]
        cosine[t], sine[t] = np.cos(path[t, 3]), np.sin(path[t, 3])
        stand(directions[t], length_m, chain, cosine[t], sine[t], joints)
        lowest[t] = lowest_of(joints)


@compiled(error_model="numpy", nogil=True)
def foot_of(bodies, foot, middle, toward, foot_m):
    """Writes middles (3, T), unit vectors to the toe (3, T) and lengths (T,) of a foot: joints from ankle to toe."""
    first, last = foot[0], foot[foot.size - 1]
    for t in range(foot_m.size):
        ankle, toe, square = bodies[t, first], bodies[t, last], 0.0
        for c in range(3):
            middle[c, t] = 0.5 * (ankle[c] + toe[c])
            square += (toe[c] - ankle[c]) ** 2
        foot_m[t] = max(np.sqrt(square), 1e-12)
        for c in range(3):
            toward[c, t] = (toe[c] - ankle[c]) / foot_m[t]


@compiled(error_model="numpy", nogil=True)
def ankle_moves(bodies, foot, toward, foot_m, foot_floor_m, moves, least_m):
    """Turns moves (6, T) of the middle of a foot into those of its ankle, and what it turns by into unit vectors.

    least_m (T,) : how high its ankle is to be so that none of its joints is below its floor, foot_floor_m (K,)
    """
    was, now = np.empty(3), np.empty(3)
    for t in range(foot_m.size):
        size = 0.0
        for c in range(3):
            was[c] = toward[c, t]
            now[c] = was[c] + moves[3 + c, t]
            size += now[c] ** 2
        size = max(np.sqrt(size), 1e-12)
        for c in range(3):
            now[c] /= size
            moves[3 + c, t] = now[c] - was[c]
            moves[c, t] -= 0.5 * foot_m[t] * moves[3 + c, t]
        least_m[t] = max(foot_floor_m[0], foot_floor_m[foot.size - 1] - foot_m[t] * now[2])
        for k in range(1, foot.size - 1):
            if foot[k] != foot[k - 1]:
                height_m = turned_height(bodies[t, foot[k]], bodies[t, foot[0]], was, now)
                least_m[t] = max(least_m[t], foot_floor_m[k] - height_m)


@compiled(error_model="numpy", nogil=True)
def put_down(bodies, feet, foot_m, moves, weight, shift, cosine, sine, path, bends):
    """Moves feet of bodies (T, J, 3) by moves (2, 6, T), a path (T, 4) by a shift (3, T); writes bends (2, T, 6)."""
    last = feet.shape[1] - 1
    for t in range(cosine.size):
        for c in range(3):
            path[t, c] += shift[c, t]
        for f in range(2):
            ankle, toe = bodies[t, feet[f, 0]], bodies[t, feet[f, last]]
            if weight[f, t] > 0.0:
                bend_of(moves[f], t, cosine[t], sine[t], bends[f, t])
                for c in range(3):
                    ankle[c] += moves[f, c, t]
                    toe[c] += moves[f, c, t] + foot_m[f, t] * moves[f, 3 + c, t]
            else:
                bends[f, t] = 0.0


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

    directions (n, T, 3B), length_m (n, B); feet (2, K) : joints from ankle to toe of each side, repeated where one has
        fewer; legs (2, 2 or 0) : as for ``bent``
    standing (n, 2, T), prints (n, 2, T, 3 or 6) : as for ``foot_moves``
    time_s (n, T) : when the points come; no joint below floor_m (n,), none of the feet below foot_floor_m (n, 2, K)
    mass (J,), stray_m (n, T) : as for ``held_up``
    bends : of the ankle and of the unit vector from ankle to toe, without heading, as ``directions``
    fastest (n,) : the greatest speed of a joint over ``FRAME_S`` or the next longer time between points, written here
    """
    n, n_times = path.shape[:2]
    bodies = np.empty((n_times, chain.shape[0] + 1, 3))
    cosine, sine, raw = np.empty(n_times), np.empty(n_times), np.empty(n_times)
    lift, lowest = np.empty(n_times), np.empty(n_times)
    foot_m, weight, least_m = np.empty((2, n_times)), np.empty((2, n_times)), np.empty((2, n_times))
    toward, left, legs_m = np.empty((2, 3, n_times)), np.empty((2, 3, n_times)), np.empty((2, 3, n_times))
    moves, follow, places = np.empty((2, 6, n_times)), np.empty((2, 3, n_times)), np.empty((2, 2, n_times))
    middle, shift, more = np.empty((3, n_times)), np.empty((3, n_times)), np.empty((3, n_times))
    bend = legs.shape[1] == 2
    for i in range(n):
        hung(directions[i], length_m[i], chain, path[i], cosine, sine, bodies, lowest)
        point_s = time_s[i, n_times - 1] / (n_times - 1)
        narrow, slow = bell(max(FEET_S / point_s, 0.3)), bell(max(ROOT_S / point_s, 0.3))
        carrying(standing[i], point_s, raw, weight)
        n_standing = 0
        for f in range(2):
            foot_of(bodies, feet[f], middle, toward[f], foot_m[f])
            own = foot_moves(middle, toward[f], standing[i, f], prints[i, f], cosine, sine, moves[f])
            n_standing += own
            ankle_moves(bodies, feet[f], toward[f], foot_m[f], foot_floor_m[i, f], moves[f], least_m[f])
            for t in range(n_times):
                raw[t] = least_m[f, t] - bodies[t, feet[f, 0], 2] - moves[f, 2, t]
            if own > 0 and raised(raw, narrow, lift):
                for t in range(n_times):
                    moves[f, 2, t] += lift[t]
        shift[:] = 0.0
        if n_standing > 0:
            mean_move(moves, weight, slow, raw, shift)
            for f in range(2):
                add(moves[f], -1.0, shift)
        if n_standing > 0 and bend:
            for f in range(2):
                hip_to_ankle(bodies, chain, legs[f], length_m[i], legs_m[f], follow[f])
            for _ in range(SETTLING):
                for f in range(2):
                    left_over(moves[f], legs_m[f], follow[f], legs[f], length_m[i], left[f])
                mean_move(left, weight, slow, raw, more)
                add(shift, 1.0, more)
                for f in range(2):
                    add(moves[f], -1.0, more)
            for _ in range(BALANCING if mass.size > 0 else 0):
                for f in range(2):
                    for c in range(2):
                        for t in range(n_times):
                            half = 0.5 * foot_m[f, t] * (toward[f, c, t] + moves[f, 3 + c, t])
                            places[f, c, t] = bodies[t, feet[f, 0], c] + moves[f, c, t] + half
                if not held_up(bodies, mass, places, weight, stray_m[i], more):
                    break
                for c in range(2):
                    smooth(more[c], slow, raw)
                    more[c] = raw
                add(shift, 1.0, more[:2])
                for f in range(2):
                    add(moves[f], -1.0, more[:2])
            for f in range(2):
                left_over(moves[f], legs_m[f], follow[f], legs[f], length_m[i], left[f])
        for t in range(n_times):
            lowest[t] = floor_m[i] - lowest[t] - shift[2, t]
            for f in range(2 if n_standing > 0 and bend else 0):
                ankle_m = bodies[t, feet[f, 0], 2] + shift[2, t] + moves[f, 2, t] - left[f, 2, t]
                lowest[t] = max(lowest[t], least_m[f, t] - ankle_m)
        if raised(lowest, narrow, lift):
            for t in range(n_times):
                shift[2, t] += lift[t]
                for f in range(2):
                    moves[f, 2, t] -= lift[t]
        put_down(bodies, feet, foot_m, moves, weight, shift, cosine, sine, path[i], bends[i])
        fastest[i] = fastest_joint(bodies, shift, time_s[i])
