"""The measures of trunk, arms and legs of one posture, into pairs of angles or into lengths, by ``columns.py``."""

from __future__ import annotations

import math

from opsim.ergonomics.columns import ANGLES, AT
from opsim.ergonomics.joints import CANONICAL
from opsim.ergonomics.kernels.compiled import compiled
from opsim.ergonomics.kernels.vectors import beyond_plane, cross, dot, in_plane, unit, way, within

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
