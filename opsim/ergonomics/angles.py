"""Joints by their canonical names.

The body's own axes, and the trunk's. z is up; what has no direction is nan, never a direction of its own.

Angles of a body, in radians, from positions (..., J, 3) whose joints have canonical names (J,).

z is up. Every angle is the same wherever the body stands and whichever way it faces; in a mirrored body left and right
change places. An angle that a posture does not have (no length, no heading, no plane to lie in) is nan.
Not knowable from joints: twist of the forearm, grip, load, force, support.
Every function raises ValueError where a joint it needs is missing, with the nearest that is there.

A skeleton as kernels read it: whole numbers only.

The measures of a posture, a column each: the one order in which arrays (..., COLUMNS) hold them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.problems import did_you_mean, shown

_TRUNK = ("pelvis", "spine", "chest", "neck", "head")
_ARM = ("shoulder", "elbow", "wrist", "hand")
_LEG = ("hip", "knee", "ankle", "toe")
CANONICAL = (
    *_TRUNK,
    *(f"{side}_{joint}" for limb in (_ARM, _LEG) for side in ("left", "right") for joint in limb),
)
"""The joints that angles are made of: trunk, left arm, right arm, left leg, right leg."""

SIDES = ("left", "right")
"""Their order along an axis of length 2."""


def joints_m(positions_m: np.ndarray, names: Sequence[str], *wanted: str) -> tuple[np.ndarray, ...]:
    """The positions (..., 3) of some joints out of (..., J, 3), which are named by ``names`` (J,).

    Raises ValueError that names every joint that is missing, with the nearest that is there.
    """
    positions_m, known = np.asarray(positions_m, dtype=float), list(names)
    if positions_m.shape[-2:] != (len(known), 3):
        raise ValueError(f"positions of {len(known)} joints must be (..., {len(known)}, 3), found {positions_m.shape}")
    missing = [f"no joint {shown(name)}; {did_you_mean(name, known)}" for name in wanted if name not in known]
    if missing:
        raise ValueError("\n".join(missing))
    return tuple(positions_m[..., known.index(name), :] for name in wanted)


def both_sides_m(positions_m: np.ndarray, names: Sequence[str], joint: str) -> np.ndarray:
    """The positions (..., 2, 3) of a joint of the limbs, left and right. Raises ValueError as ``joints_m``."""
    return np.stack(joints_m(positions_m, names, *(f"{side}_{joint}" for side in SIDES)), axis=-2)


SHORTEST_M = 1e-6
"""What is shorter has no direction."""


def body_frame(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Axes of the body, (..., J, 3) -> (..., 3, 3): rows x forward, y left along the levelled hip line, z up.

    x = y cross up. nan where the hip line is vertical: nobody can say then what is forward.
    """
    left_hip, right_hip = joints_m(positions_m, names, "left_hip", "right_hip")
    across = left_hip - right_hip
    left = unit(across * np.array([1.0, 1.0, 0.0]))
    up = np.broadcast_to([0.0, 0.0, 1.0], left.shape)
    return np.stack([np.cross(left, up), left, up + 0.0 * left], axis=-2)


def trunk_frame(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Axes of the trunk, (..., J, 3) -> (..., 3, 3): rows x forward, y left along the shoulders, z from pelvis to neck.

    The shoulder line is made square to the trunk. nan where the trunk has no length or the shoulders lie along it.
    """
    pelvis, neck = joints_m(positions_m, names, "pelvis", "neck")
    left, right = joints_m(positions_m, names, "left_shoulder", "right_shoulder")
    along, across = unit(neck - pelvis), left - right
    side = unit(across - _dot(across, along)[..., None] * along)
    return np.stack([np.cross(side, along), side, along], axis=-2)


def in_frame(frame: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) in the axes that are the rows of ``frame`` (..., 3, 3)."""
    return np.einsum("...ij,...j->...i", frame, vectors)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) at length 1; nan where shorter than ``SHORTEST_M``."""
    lengths = np.sqrt(_dot(vectors, vectors))[..., None]
    return vectors / np.where(lengths >= SHORTEST_M, lengths, np.nan)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)


NO_PLANE = 1e-6
"""A direction with less than this of its length in a plane has no angle there."""
SINGULAR_RAD = float(np.deg2rad(75.0))
"""With the arm abducted further its flexion says little: elevation is to be used."""
REFERENCES = ("trunk", "gravity")
TRUNK_JOINTS = ("pelvis", "neck", "left_hip", "right_hip")
"""What flexion of the trunk needs."""


@dataclass(frozen=True)
class TrunkAngles:
    """From pelvis to neck, all (...): flexion forward, side bend to the left, twist of the shoulders to the left."""

    flexion_rad: np.ndarray
    side_bend_rad: np.ndarray
    twist_rad: np.ndarray


@dataclass(frozen=True)
class UpperArmAngles:
    """From shoulder to elbow, all (..., 2), left and right: flexion forward, abduction to its own side, elevation.

    elevation_rad : from hanging (0) to straight up (pi), whatever the direction
    abducted      : True where abduction exceeds ``SINGULAR_RAD`` either way, so that flexion says little
    """

    flexion_rad: np.ndarray
    abduction_rad: np.ndarray
    elevation_rad: np.ndarray
    abducted: np.ndarray


@dataclass(frozen=True)
class NeckAngles:
    """From neck to head against the trunk, both (...): flexion forward of the neutral, side bend to the left."""

    flexion_rad: np.ndarray
    side_bend_rad: np.ndarray


def trunk_flexion_rad(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Flexion of the trunk alone, (...), from pelvis, neck and hips; as ``trunk_angles`` gives it, to rounding.

    NOTE: without the frame, in a quarter of the time: exposure asks for it a million times.
    """
    pelvis, neck, left_hip, right_hip = joints_m(positions_m, names, *TRUNK_JOINTS)
    across, v = left_hip - right_hip, unit(neck - pelvis)
    width = np.hypot(across[..., 0], across[..., 1])
    forward = (v[..., 0] * across[..., 1] - v[..., 1] * across[..., 0]) / np.where(width < SHORTEST_M, np.nan, width)
    return _angle(forward, v[..., 2])


def trunk_angles(positions_m: np.ndarray, names: Sequence[str]) -> TrunkAngles:
    """Flexion atan2(v.x, v.z), side bend asin(v.y), v the unit vector from pelvis to neck in the body's own frame.

    Twist is the shoulder line against the hip line after taking out the smallest rotation that brings up to v; nan for
    a trunk straight down. Flexion is nan for one straight sideways; where the hip line is vertical, everything is.
    """
    left, right = joints_m(positions_m, names, "left_shoulder", "right_shoulder")
    v = _trunk_in_body(positions_m, names)
    return TrunkAngles(_forward(v), _sideways(v), _twist(v, in_frame(body_frame(positions_m, names), left - right)))


def upper_arm_angles(positions_m: np.ndarray, names: Sequence[str], reference: str = "trunk") -> UpperArmAngles:
    """Flexion atan2(u.x, -u.z), abduction asin(u.y) to its own side, elevation the angle between u and -z.

    u is the unit vector from shoulder to elbow, in the trunk's frame or (reference "gravity") in the body's, whose z is
    up: arms that hang in a stoop are flexed by it against the trunk and not at all against gravity.
    """
    check_reference(reference)
    frame = (trunk_frame if reference == "trunk" else body_frame)(positions_m, names)[..., None, :, :]
    shoulder, elbow = (both_sides_m(positions_m, names, joint) for joint in ("shoulder", "elbow"))
    u = in_frame(frame, unit(elbow - shoulder))
    abduction_rad = _sideways(u) * np.array([1.0, -1.0])
    down = u * np.array([1.0, 1.0, -1.0])
    elevation_rad = np.arctan2(np.hypot(u[..., 0], u[..., 1]), down[..., 2])
    return UpperArmAngles(_forward(down), abduction_rad, elevation_rad, np.abs(abduction_rad) > SINGULAR_RAD)


def check_reference(reference: str) -> None:
    """Raises ValueError, with the nearest word, for what arms are not measured against."""
    if reference not in REFERENCES:
        raise ValueError(f"no reference {shown(reference)} for arms; {did_you_mean(reference, REFERENCES)}")


def neck_angles(positions_m: np.ndarray, names: Sequence[str], neutral_rad: float = 0.0) -> NeckAngles:
    """Flexion atan2(h.x, h.z) less the neutral, side bend asin(h.y), h from neck to head in the trunk's frame.

    neutral_rad : the flexion of somebody who stands and looks ahead, of ``neck_neutral_rad``
    """
    neck, head = joints_m(positions_m, names, "neck", "head")
    h = in_frame(trunk_frame(positions_m, names), unit(head - neck))
    return NeckAngles(_forward(h) - neutral_rad, _sideways(h))


def neck_neutral_rad(positions_m: np.ndarray, names: Sequence[str]) -> float:
    """The neutral of people's necks from postures (..., J, 3) in which they stand and look ahead: the median flexion.

    Heads stand 10 to 25 degrees forward of the trunk, depending on where the markers are.
    """
    return float(np.nanmedian(neck_angles(positions_m, names).flexion_rad))


def elbow_bend_rad(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Between upper arm and forearm, (..., 2), left and right: 0 for a straight arm."""
    return _bend(positions_m, names, "shoulder", "elbow", "wrist")


def wrist_bend_rad(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Between forearm and hand, (..., 2), left and right, without a sign: 0 for a straight wrist."""
    return _bend(positions_m, names, "elbow", "wrist", "hand")


def knee_bend_rad(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Between thigh and shank, (..., 2), left and right: 0 for a straight leg."""
    return _bend(positions_m, names, "hip", "knee", "ankle")


def _trunk_in_body(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    pelvis, neck = joints_m(positions_m, names, "pelvis", "neck")
    return in_frame(body_frame(positions_m, names), unit(neck - pelvis))


def _forward(v: np.ndarray) -> np.ndarray:
    """Angle of unit vectors (..., 3) in the plane of x and z, from z towards x."""
    return _angle(v[..., 0], v[..., 2])


def _angle(forward: np.ndarray, upward: np.ndarray) -> np.ndarray:
    """From up towards forward, of parts (...) of unit vectors; nan where they have no part in that plane."""
    return np.where(forward**2 + upward**2 < NO_PLANE**2, np.nan, np.arctan2(forward, upward))


def _sideways(v: np.ndarray) -> np.ndarray:
    """Angle of unit vectors (..., 3) out of the plane of x and z; NOTE: by atan2, as arcsin loses digits near 90."""
    return np.arctan2(v[..., 1], np.hypot(v[..., 0], v[..., 2]))


def _twist(v: np.ndarray, shoulders: np.ndarray) -> np.ndarray:
    """Of a shoulder line about v, against y brought along by the smallest rotation R that brings up to v.

    R a = a - ((up + v).a / (1 + v.z)) (up + v) + 2 (up.a) v, here for a = x and a = y, which are square to up.
    """
    half = v + np.array([0.0, 0.0, 1.0])
    fold = half / np.where(half[..., 2:] > NO_PLANE, half[..., 2:], np.nan)
    x, y = (np.eye(3)[axis] - v[..., axis, None] * fold for axis in (0, 1))
    left, back = np.einsum("...i,...i->...", shoulders, y), -np.einsum("...i,...i->...", shoulders, x)
    whole = np.sqrt(np.einsum("...i,...i->...", shoulders, shoulders))
    seen = np.hypot(left, back) > NO_PLANE * np.maximum(whole, NO_PLANE)
    return np.where(seen, np.arctan2(back, left), np.nan)


def _bend(positions_m: np.ndarray, names: Sequence[str], *chain: str) -> np.ndarray:
    """(..., 2) angle between two bones that follow each other; by atan2, since arccos loses half the digits near 0."""
    top, middle, end = (both_sides_m(positions_m, names, joint) for joint in chain)
    a, b = unit(middle - top), unit(end - middle)
    return np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.einsum("...i,...i->...", a, b))


def bone_chain(parents: Sequence[int]) -> np.ndarray:
    """(B, 3) bone, parent and child joint of each bone, from the root outwards: a parent comes before its children.

    Each joint but the root (parent -1) ends one bone; bones are numbered in the order of their joints.
    """
    joints = [joint for joint, parent in enumerate(parents) if parent >= 0]
    links = [(bone, parents[joint], joint) for bone, joint in enumerate(joints)]
    return np.array(sorted(links, key=lambda link: _depth(parents, link[2])), dtype=np.int64).reshape(-1, 3)


def joint_places(names: Sequence[str]) -> np.ndarray:
    """(21,) the number of each joint of ``CANONICAL`` among ``names`` (J,); J where it is missing."""
    number = {name: joint for joint, name in enumerate(names)}
    return np.array([number.get(name, len(names)) for name in CANONICAL], dtype=np.int64)


def _depth(parents: Sequence[int], joint: int) -> int:
    depth = 0
    while parents[joint] >= 0 and depth < len(parents):
        joint, depth = parents[joint], depth + 1
    return depth


ANGLES = (
    *("trunk_flexion", "trunk_side", "trunk_twist", "neck_flexion", "neck_side"),
    *(f"{side}_{angle}" for angle in ("arm_flexion", "arm_abduction", "arm_elevation") for side in ("left", "right")),
    *(f"{side}_{angle}" for angle in ("elbow", "wrist", "knee") for side in ("left", "right")),
)
"""Degrees; nan where a posture does not have one. Arm flexion and abduction are against ``Options.arm_reference``,
arm elevation is always against gravity; the rest as ``angles.py``. Neck flexion is less the neutral of the body."""
LENGTHS = (
    *("left_elbow_above_m", "right_elbow_above_m"),
    *("left_across_m", "right_across_m", "left_outside_m", "right_outside_m"),
    *(
        "left_hand_up_m",
        "right_hand_up_m",
        "hands_forward_m",
        "hands_left_m",
        "left_ankle_up_m",
        "right_ankle_up_m",
        "pelvis_up_m",
    ),
)
"""Metres: elbow above its shoulder; hand beyond the midline, and outside its own shoulder, both in the trunk's frame;
hands above the floor (the lowest foot), the middle of the hands forward and to the left of the middle of the ankles, in
the body's frame (level); ankles and pelvis above the floor. The wrist stands for a hand that is missing."""
COLUMNS = (*ANGLES, *LENGTHS)
AT = {name: place for place, name in enumerate(COLUMNS)}
