"""Joints of postures, and legs put on given ankles, frame by frame.

Its twin: tests/naive_walk.py, all frames at once.
"""

from __future__ import annotations

import numpy as np

from emulator.kernels.compiled import compiled

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
