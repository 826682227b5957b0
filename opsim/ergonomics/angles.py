"""Angles of a body, in radians, from positions (..., J, 3) whose joints have canonical names (J,).

z is up. Every angle is the same wherever the body stands and whichever way it faces; in a mirrored body left and right
change places. An angle that a posture does not have (no length, no heading, no plane to lie in) is nan.
Not knowable from joints: twist of the forearm, grip, load, force, support.
Every function raises ValueError where a joint it needs is missing, with the nearest that is there.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from opsim.ergonomics.frames import SHORTEST_M, body_frame, in_frame, trunk_frame, unit
from opsim.ergonomics.joints import both_sides_m, joints_m
from opsim.problems import did_you_mean, shown

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
