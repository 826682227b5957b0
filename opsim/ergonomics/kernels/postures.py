"""Many arc tangents at once: arithmetic only, so that the loop vectorises. Twin: ``numpy.arctan2``.

Vectors of three numbers, as tuples: nothing is allocated. What has no direction is nan, as in ``frames.py``.

The measures of trunk, arms and legs of one posture, into pairs of angles or into lengths, by ``columns.py``.

Measures of postures, frame by frame. Twin: ``posture_measures.measures_of_positions``.

No measure asks for a place or a heading, so joints are hung on the root wherever that stands. Angles are left as pairs
(opposite, adjacent), whose arc tangents are taken for many frames at once.
"""

from __future__ import annotations

import math

import numpy as np

from opsim.ergonomics.angles import ANGLES, AT, CANONICAL
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


SHORTEST_SQUARED = 1e-6**2
NO_PLANE_SQUARED = 1e-6**2
"""``frames.SHORTEST_M`` and ``angles.NO_PLANE``, squared."""


@compiled(error_model="numpy", nogil=True)
def way(a, b):
    """From point a to point b."""
    return b[0] - a[0], b[1] - a[1], b[2] - a[2]


@compiled(error_model="numpy", nogil=True)
def unit(v):
    """v at length 1; nan where it is shorter than 1e-6."""
    squared = dot(v, v)
    over = 1.0 / math.sqrt(squared) if squared >= SHORTEST_SQUARED else math.nan
    return v[0] * over, v[1] * over, v[2] * over


@compiled(error_model="numpy", nogil=True)
def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@compiled(error_model="numpy", nogil=True)
def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@compiled(error_model="numpy", nogil=True)
def within(frame, v):
    """v in the axes of a frame (x, y, z)."""
    return dot(frame[0], v), dot(frame[1], v), dot(frame[2], v)


@compiled(error_model="numpy", nogil=True)
def in_plane(opposite, adjacent):
    """adjacent, or nan where a unit vector has too little in this plane for an angle there."""
    return adjacent if opposite * opposite + adjacent * adjacent >= NO_PLANE_SQUARED else math.nan


@compiled(error_model="numpy", nogil=True)
def beyond_plane(x, z):
    """What stands square to y: with y it makes the angle out of the plane of x and z."""
    return math.sqrt(x * x + z * z)


N_ANGLES, NECK_FLEXION = len(ANGLES), AT["neck_flexion"]
TRUNK_FLEXION, TRUNK_SIDE, TRUNK_TWIST, NECK_SIDE = (
    AT[name] for name in ("trunk_flexion", "trunk_side", "trunk_twist", "neck_side")
)
FLEXION, ABDUCTION, ELEVATION, ELBOW_BEND, WRIST_BEND, KNEE_BEND = (
    AT[f"left_{name}"] for name in ("arm_flexion", "arm_abduction", "arm_elevation", "elbow", "wrist", "knee")
)
ABOVE, ACROSS, OUTSIDE, HAND_UP, ANKLE_UP = (
    AT[f"left_{name}_m"] for name in ("elbow_above", "across", "outside", "hand_up", "ankle_up")
)
FORWARD, LEFTWARD, PELVIS_UP = AT["hands_forward_m"], AT["hands_left_m"], AT["pelvis_up_m"]
"""Columns; of both sides the left, and the right comes next."""
PELVIS, NECK, HEAD = (CANONICAL.index(joint) for joint in ("pelvis", "neck", "head"))
SHOULDER, ELBOW, WRIST, HAND, HIP, KNEE, ANKLE, TOE = (
    CANONICAL.index(f"left_{joint}") for joint in ("shoulder", "elbow", "wrist", "hand", "hip", "knee", "ankle", "toe")
)
OTHER = CANONICAL.index("right_hip") - HIP
"""Places among the joints, of the left; those of the right come so many later."""
HALF_FOLDED = 1e-6
"""``angles.NO_PLANE``: less than this of the way up, and a trunk points straight down."""


@compiled(error_model="numpy", nogil=True)
def trunk(joints_m, at, opposite, adjacent):
    """Angles of trunk and neck -> the body's forward and left, level, and the axes of the trunk."""
    pelvis, neck = joints_m[at[PELVIS]], joints_m[at[NECK]]
    hips = way(joints_m[at[HIP + OTHER]], joints_m[at[HIP]])
    left = unit((hips[0], hips[1], 0.0))
    forward = (left[1], -left[0], 0.0)
    along = unit(way(pelvis, neck))
    shoulders = way(joints_m[at[SHOULDER + OTHER]], joints_m[at[SHOULDER]])
    x, y, z = dot(forward, along), dot(left, along), along[2]
    opposite[TRUNK_FLEXION], adjacent[TRUNK_FLEXION] = x, in_plane(x, z)
    opposite[TRUNK_SIDE], adjacent[TRUNK_SIDE] = y, beyond_plane(x, z)
    across = (dot(forward, shoulders), dot(left, shoulders), shoulders[2])
    opposite[TRUNK_TWIST], adjacent[TRUNK_TWIST] = _twist((x, y, z), across)
    apart = dot(shoulders, along)
    side = unit((shoulders[0] - apart * along[0], shoulders[1] - apart * along[1], shoulders[2] - apart * along[2]))
    frame = (cross(side, along), side, along)
    x, y, z = within(frame, unit(way(neck, joints_m[at[HEAD]])))
    opposite[NECK_FLEXION], adjacent[NECK_FLEXION] = x, in_plane(x, z)
    opposite[NECK_SIDE], adjacent[NECK_SIDE] = y, beyond_plane(x, z)
    return forward, left, frame


@compiled(error_model="numpy", nogil=True)
def _twist(v, shoulders):
    """The pair of ``angles._twist``: y brought along by the smallest rotation from up to v, against the shoulders."""
    over = 1.0 / (v[2] + 1.0) if v[2] + 1.0 > HALF_FOLDED else math.nan
    fold = (v[0] * over, v[1] * over, 1.0 + 0.0 * over)
    ahead = shoulders[0] - v[0] * dot(fold, shoulders)
    left = shoulders[1] - v[1] * dot(fold, shoulders)
    whole = max(math.sqrt(dot(shoulders, shoulders)), HALF_FOLDED)
    seen = math.sqrt(left * left + ahead * ahead) > HALF_FOLDED * whole
    return -ahead, left if seen else math.nan


@compiled(error_model="numpy", nogil=True)
def arm(joints_m, at, side, forward, left, frame, gravity, opposite, adjacent):
    """Angles of the upper arm, elbow and wrist of a side: 0 left, 1 right."""
    there = side * OTHER
    shoulder, elbow = joints_m[at[SHOULDER + there]], joints_m[at[ELBOW + there]]
    wrist, hand = joints_m[at[WRIST + there]], joints_m[at[HAND + there]]
    upper, fore = unit(way(shoulder, elbow)), unit(way(elbow, wrist))
    x, y, z = within(frame, upper)
    if gravity:
        x, y, z = dot(forward, upper), dot(left, upper), upper[2]
    opposite[FLEXION + side], adjacent[FLEXION + side] = x, in_plane(x, -z)
    opposite[ABDUCTION + side], adjacent[ABDUCTION + side] = y if side == 0 else -y, beyond_plane(x, z)
    opposite[ELEVATION + side], adjacent[ELEVATION + side] = beyond_plane(upper[0], upper[1]), -upper[2]
    opposite[ELBOW_BEND + side], adjacent[ELBOW_BEND + side] = _bend(upper, fore)
    opposite[WRIST_BEND + side], adjacent[WRIST_BEND + side] = _bend(fore, unit(way(wrist, hand)))


@compiled(error_model="numpy", nogil=True)
def leg(joints_m, at, side, opposite, adjacent):
    """The bend of a side's knee."""
    there = side * OTHER
    hip, knee, ankle = joints_m[at[HIP + there]], joints_m[at[KNEE + there]], joints_m[at[ANKLE + there]]
    opposite[KNEE_BEND + side], adjacent[KNEE_BEND + side] = _bend(unit(way(hip, knee)), unit(way(knee, ankle)))


@compiled(error_model="numpy", nogil=True)
def _bend(a, b):
    square = cross(a, b)
    return math.sqrt(dot(square, square)), dot(a, b)


@compiled(error_model="numpy", nogil=True)
def hand_of(joints_m, at, side):
    """The hand of a side, or its wrist where there is none."""
    hand, wrist = joints_m[at[HAND + side * OTHER]], joints_m[at[WRIST + side * OTHER]]
    return wrist if math.isnan(hand[0] + hand[1] + hand[2]) else hand


@compiled(error_model="numpy", nogil=True)
def beside(joints_m, at, side, frame, out):
    """The elbow above its shoulder; the hand across the midline and outside the shoulder, along the trunk's y."""
    shoulder, elbow = joints_m[at[SHOULDER + side * OTHER]], joints_m[at[ELBOW + side * OTHER]]
    hand, own = hand_of(joints_m, at, side), 1.0 if side == 0 else -1.0
    out[ABOVE + side] = elbow[2] - shoulder[2]
    out[ACROSS + side] = -own * dot(frame[1], way(joints_m[at[NECK]], hand))
    out[OUTSIDE + side] = own * dot(frame[1], way(shoulder, hand))


@compiled(error_model="numpy", nogil=True)
def heights(joints_m, at, out):
    """Hands, ankles and pelvis above the floor: the lowest of the ankles and toes that there are."""
    floor_m = math.nan
    for foot in (ANKLE, ANKLE + OTHER, TOE, TOE + OTHER):
        height_m = joints_m[at[foot], 2]
        floor_m = floor_m if height_m >= floor_m or math.isnan(height_m) else height_m
    for side in range(2):
        out[HAND_UP + side] = hand_of(joints_m, at, side)[2] - floor_m
        out[ANKLE_UP + side] = joints_m[at[ANKLE + side * OTHER], 2] - floor_m
    out[PELVIS_UP] = joints_m[at[PELVIS], 2] - floor_m


@compiled(error_model="numpy", nogil=True)
def reach(joints_m, at, forward, left, out):
    """The middle of the hands from the middle of the ankles, forward and to the left in the body's frame."""
    one, other = hand_of(joints_m, at, 0), hand_of(joints_m, at, 1)
    ankle, next_ankle = joints_m[at[ANKLE]], joints_m[at[ANKLE + OTHER]]
    x = 0.5 * (one[0] + other[0]) - 0.5 * (ankle[0] + next_ankle[0])
    y = 0.5 * (one[1] + other[1]) - 0.5 * (ankle[1] + next_ankle[1])
    out[FORWARD] = forward[0] * x + forward[1] * y
    out[LEFTWARD] = left[0] * x + left[1] * y


TOGETHER = 64
"""Frames whose pairs are held at a time: they should stay in the cache."""


@compiled(error_model="numpy", nogil=True)
def measure_hung(directions, lengths_m, chain, at, neutral_deg, gravity, out):
    """Measures out (n, S, COLUMNS) of bones with directions (n, S, B, 3) and lengths (n, B).

    chain (B, 3) : bone, parent and child joint from the root outwards
    at (21,)     : the joint at each place of ``joints.CANONICAL``; J, beyond the last, where the skeleton has none
    gravity      : whether flexion and abduction of arms are taken against gravity and not the trunk
    """
    joints_m = np.full((chain.shape[0] + 2, 3), math.nan)
    joints_m[chain[0, 1]] = 0.0
    for i in range(out.shape[0]):
        for start in range(0, out.shape[1], TOGETHER):
            stop = min(start + TOGETHER, out.shape[1])
            opposite, adjacent = np.empty((stop - start, N_ANGLES)), np.empty((stop - start, N_ANGLES))
            for s in range(start, stop):
                _hang(directions[i, s], lengths_m[i], chain, joints_m)
                _measure(joints_m, at, gravity, opposite[s - start], adjacent[s - start], out[i, s])
            _angles(opposite, adjacent, neutral_deg, out[i, start:stop])


@compiled(error_model="numpy", nogil=True)
def measure_joints(positions_m, at, neutral_deg, gravity, out):
    """Measures out (N, COLUMNS) of joints positions_m (N, J, 3); the others as ``measure_hung``."""
    n_joints = positions_m.shape[1]
    joints_m = np.full((n_joints + 1, 3), math.nan)
    for start in range(0, out.shape[0], TOGETHER):
        stop = min(start + TOGETHER, out.shape[0])
        opposite, adjacent = np.empty((stop - start, N_ANGLES)), np.empty((stop - start, N_ANGLES))
        for s in range(start, stop):
            joints_m[:n_joints] = positions_m[s]
            _measure(joints_m, at, gravity, opposite[s - start], adjacent[s - start], out[s])
        _angles(opposite, adjacent, neutral_deg, out[start:stop])


@compiled(error_model="numpy", nogil=True)
def _hang(directions, lengths_m, chain, joints_m):
    """Joints (J + 1, 3) at the ends of bones from the root, which stays; the last is nobody's."""
    for link in range(chain.shape[0]):
        bone, parent, child = chain[link, 0], chain[link, 1], chain[link, 2]
        for axis in range(3):
            joints_m[child, axis] = joints_m[parent, axis] + directions[bone, axis] * lengths_m[bone]


@compiled(error_model="numpy", nogil=True)
def _measure(joints_m, at, gravity, opposite, adjacent, out):
    """One posture: pairs of its angles (N_ANGLES,), and lengths into out (COLUMNS,) behind them."""
    forward, left, frame = trunk(joints_m, at, opposite, adjacent)
    for side in range(2):
        arm(joints_m, at, side, forward, left, frame, gravity, opposite, adjacent)
        leg(joints_m, at, side, opposite, adjacent)
        beside(joints_m, at, side, frame, out)
    heights(joints_m, at, out)
    reach(joints_m, at, forward, left, out)


@compiled(error_model="numpy", nogil=True)
def _angles(opposite, adjacent, neutral_deg, out):
    degrees = np.empty(opposite.size)
    arctan2_deg(opposite.reshape(-1), adjacent.reshape(-1), degrees)
    out[:, :N_ANGLES] = degrees.reshape(opposite.shape)
    out[:, NECK_FLEXION] -= neutral_deg
