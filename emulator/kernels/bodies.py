"""Bodies from directions: joints by walking down the bones, and the way of a root that rides on planted feet.

Their twins: Skeleton.positions with motion.turn, RootChannel.inverse_numpy, tests/naive.

Forward kinematics of a hierarchy of joints with channels, frame by frame. Twin: ``naive_hierarchy`` in tests.

Joints of postures, and legs put on given ankles, frame by frame.

Its twin: tests/naive/walk.py, all frames at once.

The way of a root whose bearing feet stay, frame by frame. Its twin: naive_way in tests/naive/walk.py.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled
from emulator.kernels.sphere import FAST


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def stand(directions, length_m, chain, cosine, sine, joints):
    """Joints (J, 3) below a root already placed: directions (3B,), turned about the vertical by cosine and sine.

    chain (B, 3) : bone, parent joint, child joint; a parent comes before its children
    """
    for k in range(chain.shape[0]):
        bone, parent, child = chain[k, 0], chain[k, 1], chain[k, 2]
        x, y, z = directions[3 * bone], directions[3 * bone + 1], directions[3 * bone + 2]
        joints[child, 0] = joints[parent, 0] + length_m[bone] * (cosine * x - sine * y)
        joints[child, 1] = joints[parent, 1] + length_m[bone] * (sine * x + cosine * y)
        joints[child, 2] = joints[parent, 2] + length_m[bone] * z


# NOTE: no fused multiply-add, so that the root is to the bit where root_m puts it.
@compiled(error_model="numpy", nogil=True)
def stand_all(directions, length_m, chain, path, joints):
    """Joints (n, S, J, 3) of directions (n, S, 3B) and lengths (n, B) on paths (n, S, 4).

    path : x, y, z of the root in metres and its heading in radians
    """
    top = chain[0, 1]
    for i in range(directions.shape[0]):
        for s in range(directions.shape[1]):
            at = path[i, s]
            for c in range(3):
                joints[i, s, top, c] = at[c]
            stand(directions[i, s], length_m[i], chain, np.cos(at[3]), np.sin(at[3]), joints[i, s])


@compiled(fastmath=FAST, error_model="numpy", nogil=True)
def ride_all(directions, length_m, chain, feet, soft_m, channel, leg_m, lowest_m, root):
    """The way of the root (n, T, 3) from directions (n, T, 3B) and channel (n, T, 4); see ``root.RootChannel``.

    feet (F,) : joints that may carry; leg_m (n,) : what slip and clearance are measured in
    lowest_m  : no joint gets below this height
    """
    n_feet = feet.size
    joints = np.zeros((chain.shape[0] + 1, 3))
    place, share = np.zeros((2, n_feet, 2)), np.zeros((2, n_feet))
    for i in range(directions.shape[0]):
        way_x, way_y = 0.0, 0.0
        for t in range(directions.shape[1]):
            stand(directions[i, t], length_m[i], chain, np.cos(channel[i, t, 3]), np.sin(channel[i, t, 3]), joints)
            lowest, lowest_foot = np.inf, np.inf
            for j in range(joints.shape[0]):
                lowest = min(lowest, joints[j, 2])
            for f in range(n_feet):
                lowest_foot = min(lowest_foot, joints[feet[f], 2])
            now, last = t % 2, 1 - t % 2
            weight = 0.0
            for f in range(n_feet):
                place[now, f, 0], place[now, f, 1] = joints[feet[f], 0], joints[feet[f], 1]
                share[now, f] = np.exp((lowest_foot - joints[feet[f], 2]) / soft_m)
                weight += share[now, f]
            for f in range(n_feet):
                share[now, f] /= weight
                if t > 0:
                    both = 0.5 * (share[now, f] + share[last, f])
                    way_x -= both * (place[now, f, 0] - place[last, f, 0])
                    way_y -= both * (place[now, f, 1] - place[last, f, 1])
            floor = soft_m * np.log(weight / n_feet) - lowest_foot if n_feet else 0.0
            root[i, t, 0] = way_x + channel[i, t, 0] * leg_m[i]
            root[i, t, 1] = way_y + channel[i, t, 1] * leg_m[i]
            root[i, t, 2] = max(floor + channel[i, t, 2] * leg_m[i], lowest_m - lowest)
        for c in range(2):
            start = root[i, 0, c]
            for t in range(directions.shape[1]):
                root[i, t, c] -= start


@compiled(nogil=True, error_model="numpy")
def walk(values, order, parents, first, column, kind, offsets, axes, with_bone, joints):
    """Joints (T, J, 3) of channel values (T, C); angles in degrees.

    order (J,)     : joints, parents before children; parents (J,) with -1
    first (J + 1,) : joint j has the steps first[j] to first[j + 1] - 1 of column (S,) and kind (S,):
                     kind 0, 1, 2 sets x, y, z of its displacement; 3, 4, 5 turns about x, y, z, the last first
    offsets (J, 3) : displacement from the parent where no channel sets it
    axes (J, 3, 3) : frame in which a joint turns; with_bone: the displacement turns with the joint itself (ASF),
                     not with its parent (BVH; axes are then not looked at)
    """
    n_joints = order.size
    turned = np.empty((n_joints, 3, 3))
    local, other = np.empty((3, 3)), np.empty((3, 3))
    step = np.empty(3)
    for t in range(values.shape[0]):
        for k in range(n_joints):
            j = order[k]
            parent = parents[j]
            for a in range(3):
                step[a] = offsets[j, a]
                for b in range(3):
                    local[a, b] = 1.0 if a == b else 0.0
            for s in range(first[j], first[j + 1]):
                value = values[t, column[s]]
                if kind[s] < 3:
                    step[kind[s]] = value
                else:
                    turn_about(local, kind[s] - 3, value)
            if with_bone:
                multiply(axes[j], local, other)
                multiply_transposed(other, axes[j], local)
            if parent >= 0:
                multiply(turned[parent], local, turned[j])
            else:
                turned[j] = local
            carrier = j if with_bone else parent
            for a in range(3):
                moved = step[a]
                if carrier >= 0 and parent >= 0:
                    moved = turned[carrier, a, 0] * step[0] + turned[carrier, a, 1] * step[1]
                    moved += turned[carrier, a, 2] * step[2]
                joints[t, j, a] = moved + (joints[t, parent, a] if parent >= 0 else 0.0)


@compiled(nogil=True, error_model="numpy", inline="always")
def turn_about(matrix, axis, angle_deg):
    """matrix (3, 3) times the turn about axis 0, 1 or 2, written into it."""
    angle = np.radians(angle_deg)
    cosine, sine = np.cos(angle), np.sin(angle)
    b, c = (axis + 1) % 3, (axis + 2) % 3
    for a in range(3):
        left, right = matrix[a, b], matrix[a, c]
        matrix[a, b] = left * cosine + right * sine
        matrix[a, c] = right * cosine - left * sine


@compiled(nogil=True, error_model="numpy", inline="always")
def multiply(left, right, out):
    for a in range(3):
        for b in range(3):
            out[a, b] = left[a, 0] * right[0, b] + left[a, 1] * right[1, b] + left[a, 2] * right[2, b]


@compiled(nogil=True, error_model="numpy", inline="always")
def multiply_transposed(left, right, out):
    for a in range(3):
        for b in range(3):
            out[a, b] = left[a, 0] * right[b, 0] + left[a, 1] * right[b, 1] + left[a, 2] * right[b, 2]


REACH = 0.996
"""The most of its length to which a leg stretches."""
SOFT_M = 0.004
"""How softly the hips come down where a leg would have to stretch."""
AHEAD = 0.3


@compiled(error_model="numpy", nogil=True)
def hung(flat, yaw_rad, root_m, length_m, chain, joints):
    """Joints (T, J, 3) of poses laid flat (T, 3B + 4), their directions made unit, turned by yaw_rad (T,), at root_m.

    root_m (T, 3), length_m (B,); chain (b, 3) : bone, parent joint, child joint, from the root outwards; joints that
    it leaves out are not written
    """
    top = chain[0, 1]
    for t in range(yaw_rad.size):
        cosine, sine = np.cos(yaw_rad[t]), np.sin(yaw_rad[t])
        for c in range(3):
            joints[t, top, c] = root_m[t, c]
        for k in range(chain.shape[0]):
            bone, parent, child = chain[k, 0], chain[k, 1], chain[k, 2]
            x, y, z = flat[t, 3 * bone], flat[t, 3 * bone + 1], flat[t, 3 * bone + 2]
            by = length_m[bone] / max(np.sqrt(x * x + y * y + z * z), 1e-12)
            joints[t, child, 0] = joints[t, parent, 0] + by * (cosine * x - sine * y)
            joints[t, child, 1] = joints[t, parent, 1] + by * (sine * x + cosine * y)
            joints[t, child, 2] = joints[t, parent, 2] + by * z


@compiled(error_model="numpy", nogil=True)
def wanting(joints, ankles, legs, bone_m):
    """How much the hips must come down so that no leg of joints (J, 3) stretches to its ankle (2, 3)."""
    most = -np.inf
    for side in range(2):
        hip, knee, ankle = legs[side, 0], legs[side, 1], legs[side, 2]
        full = REACH * (bone_m[knee] + bone_m[ankle])
        x, y, z = (
            ankles[side, 0] - joints[hip, 0],
            ankles[side, 1] - joints[hip, 1],
            ankles[side, 2] - joints[hip, 2],
        )
        level = min(np.sqrt(x * x + y * y), 0.98 * full)
        most = max(most, -(z + np.sqrt(full**2 - level**2)))
    return most


@compiled(error_model="numpy", nogil=True)
def wanting_all(joints, ankles, legs, bone_m, out):
    """``wanting`` (T,) of all frames."""
    for t in range(out.size):
        out[t] = wanting(joints[t], ankles[t], legs, bone_m)


@compiled(error_model="numpy", nogil=True)
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled(error_model="numpy", nogil=True)
def make_unit(a):
    by = 1.0 / max(np.sqrt(dot(a, a)), 1e-12)
    for c in range(3):
        a[c] *= by


@compiled(error_model="numpy", nogil=True)
def bent_to(hip, knee, ankle, foot, along, side):
    """Writes the side (3,) to which a knee is bent: off the line from hip to ankle, and a little where the foot points.

    The latter decides where the leg is nearly straight, so that a knee never turns round.
    """
    for c in range(3):
        along[c], side[c] = ankle[c] - hip[c], knee[c] - hip[c]
    make_unit(along)
    thigh = np.sqrt(dot(side, side))
    beside = dot(side, along)
    level = AHEAD / max(np.sqrt(foot[0] * foot[0] + foot[1] * foot[1]), 1e-12)
    for c in range(3):
        side[c] = (side[c] - beside * along[c]) / thigh
    side[0] += level * foot[0]
    side[1] += level * foot[1]


@compiled(error_model="numpy", nogil=True)
def two_bones(start, target, upper, lower, side, along, middle, end):
    """Writes middle and end (3,) of a limb; its middle lies on the ``side`` (3,) of the line where it was."""
    for c in range(3):
        along[c] = target[c] - start[c]
    distance = np.sqrt(dot(along, along))
    for c in range(3):
        along[c] /= max(distance, 1e-9)
    reach = min(max(distance, abs(upper - lower) + 0.02), REACH * (upper + lower))
    fore = (upper**2 - lower**2 + reach**2) / (2.0 * reach)
    beside = dot(side, along)
    for c in range(3):
        side[c] -= beside * along[c]
    height = np.sqrt(max(upper**2 - fore**2, 0.0)) / max(np.sqrt(dot(side, side)), 1e-9)
    # exactly as long as they are, whatever rounding did
    for c in range(3):
        side[c] = fore * along[c] + height * side[c]
    make_unit(side)
    for c in range(3):
        middle[c] = start[c] + upper * side[c]
        along[c] = start[c] + reach * along[c] - middle[c]
    make_unit(along)
    for c in range(3):
        end[c] = middle[c] + lower * along[c]


@compiled(error_model="numpy", nogil=True)
def stand_on(joints, ankles, feet, legs, below, bone_m, out):
    """Joints out (T, J, 3) with ankles at (T, 2, 3), feet along unit vectors (T, 2, 3), knees on their side of joints.

    legs (2, 4) hip to toe; below (2, K, 2) joint and parent of what hangs on an ankle besides, -1 for none;
    bone_m (J,) length of the bone that ends in a joint. An ankle out of reach is approached to ``REACH`` of the leg.
    """
    side, along = np.empty(3), np.empty(3)
    for t in range(joints.shape[0]):
        raw, to = joints[t], out[t]
        want = wanting(raw, ankles[t], legs, bone_m) / SOFT_M
        lower = SOFT_M * (max(want, 0.0) + np.log1p(np.exp(-abs(want))))
        for j in range(raw.shape[0]):
            to[j, 0], to[j, 1], to[j, 2] = raw[j, 0], raw[j, 1], raw[j, 2] - lower
        for number in range(2):
            hip, knee, ankle, toe = legs[number]
            bent_to(raw[hip], raw[knee], raw[ankle], feet[t, number], along, side)
            two_bones(to[hip], ankles[t, number], bone_m[knee], bone_m[ankle], side, along, to[knee], to[ankle])
            for k in range(below.shape[1]):
                joint, parent = below[number, k]
                if joint < 0:
                    break
                for c in range(3):
                    to[joint, c] = to[parent, c] + raw[joint, c] - raw[parent, c]
                if joint == toe and parent == ankle:
                    length = 0.0
                    for c in range(3):
                        length += (raw[toe, c] - raw[ankle, c]) ** 2
                    for c in range(3):
                        to[toe, c] = to[ankle, c] + np.sqrt(length) * feet[t, number, c]


RISE = 0.05
"""The heel rises where the foot points this much (of its length) further down than when it stands."""


@compiled(error_model="numpy", nogil=True)
def run_end(contact, both, start):
    """One beyond the last frame from ``start`` on in which both feet bear (or, with ``both`` False, neither does)."""
    stop = start
    while stop < contact.shape[0] and contact[stop, 0] == both and contact[stop, 1] == both:
        stop += 1
    return stop


@compiled(error_model="numpy", nogil=True)
def shared(contact, share):
    """Writes how much each foot carries (T, 2): see ``feet.shares``."""
    n = contact.shape[0]
    for t in range(n):
        for f in range(2):
            share[t, f] = 1.0 if contact[t, f] else 0.0
    start = 0
    while start < n:
        stop = run_end(contact, True, start)
        for t in range(start, stop):
            ease = (t - start + 1) / (stop - start + 1)
            for f in range(2):
                before = share[start - 1, f] if start else 0.5
                after = share[stop, f] if stop < n else 0.5
                share[t, f] = (1.0 - ease) * before + ease * after
        start = max(stop, start + 1)
    for t in range(n):
        if not contact[t, 0] and not contact[t, 1]:
            for f in range(2):
                share[t, f] = share[t - 1, f] if t else 0.5
    for t in range(n):
        total = share[t, 0] + share[t, 1]
        if total > 0:
            share[t] /= total


@compiled(error_model="numpy", nogil=True)
def rise_of(down, start, stop, held):
    """The frame of a stance [start, stop) from which a foot pointing ``down`` (T,) turns about its toe, or stop."""
    n = stop - start
    if held or n < 4:
        return stop
    middle = np.median(down[start + n // 4 : start + max(n // 2, n // 4 + 1)])
    last = -1
    for t in range(n):
        if down[start + t] <= middle + RISE:
            last = t
    return start + max(last if last >= 0 else n // 2, n // 4)


@compiled(error_model="numpy", nogil=True)
def ridden(hanging, contact, feet, way):
    """Writes the level way (T, 2) of the root of joints (T, J, 3), root at 0, from x = y = 0, if bearing feet stay.

    contact (T, 2); feet (2, 2) : ankle and toe of each side
    """
    n = contact.shape[0]
    share, down, pivot = np.empty((n, 2)), np.empty(n), np.empty(n, dtype=np.int64)
    shared(contact, share)
    way[:] = 0.0
    for f in range(2):
        ankle, toe = feet[f]
        pivot[:] = ankle
        for t in range(n):
            square = 0.0
            for c in range(3):
                square += (hanging[t, toe, c] - hanging[t, ankle, c]) ** 2
            down[t] = (hanging[t, ankle, 2] - hanging[t, toe, 2]) / np.sqrt(square)
        start = 0
        while start < n:
            stop = start
            while stop < n and contact[stop, f]:
                stop += 1
            if stop > start:
                pivot[rise_of(down, start, stop, stop == n) : stop - 1] = toe
            start = max(stop, start + 1)
        for c in range(2):
            gone = 0.0
            for t in range(1, n):
                gone += (
                    0.5
                    * (share[t, f] + share[t - 1, f])
                    * (hanging[t, pivot[t - 1], c] - hanging[t - 1, pivot[t - 1], c])
                )
                way[t, c] -= gone
