"""Joint angles that positions alone can tell, and how far a healthy adult's joints go."""

from __future__ import annotations

import numpy as np

from emulator.skeleton import Skeleton

LIMITS_DEG: dict[str, tuple[float, float]] = {
    "elbow flexion": (0.0, 150.0),
    "knee flexion": (-10.0, 135.0),
    "hip flexion": (-30.0, 120.0),
    "hip abduction": (-30.0, 45.0),
    "shoulder extension": (-90.0, 60.0),
    "trunk flexion": (-25.0, 80.0),
    "trunk side bend": (-35.0, 35.0),
    "neck flexion": (-45.0, 45.0),
    "neck side bend": (-45.0, 45.0),
}
"""Least and greatest angle. Source: American Academy of Orthopaedic Surgeons (1965), Joint Motion: Method of Measuring
and Recording; trunk as its thoracic and lumbar spine. Averages of healthy adults: some people go further."""

_Places = dict[str, np.ndarray]
_NEEDED = (
    *("pelvis", "spine", "chest", "neck", "head"),
    *(f"{side}_{j}" for side in ("left", "right") for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")),
)


def joint_angles_deg(skeleton: Skeleton, positions: np.ndarray) -> dict[str, np.ndarray]:
    """Angles in degrees under the names of ``LIMITS_DEG``, (..., 2) for left and right or (..., 1) for the middle.

    positions : (..., J, 3), z up or not, any unit: only directions between joints enter
    An angle whose plane says nothing (a thigh straight to the side has no hip flexion) is NaN.
    Raises ValueError where the skeleton lacks one of the canonical joints needed.
    """
    at = {name: positions[..., skeleton.index(name), :] for name in _NEEDED}
    lower = _frame(at["left_hip"] - at["right_hip"], at["spine"] - at["pelvis"])
    upper = _frame(at["left_shoulder"] - at["right_shoulder"], at["neck"] - at["chest"])
    above, head = _unit(at["neck"] - at["chest"]), _unit(at["head"] - at["neck"])
    sides = {
        "elbow flexion": _elbow,
        "knee flexion": _knee,
        "hip flexion": _hip_flexion,
        "hip abduction": _hip_abduction,
        "shoulder extension": _shoulder_extension,
    }
    found = {
        name: np.stack([angle(at, side, lower, upper) for side in ("left", "right")], -1)
        for name, angle in sides.items()
    }
    for name, bone, frame in (("trunk", above, lower), ("neck", head, upper)):
        found[f"{name} flexion"] = _in_plane(bone, frame, 1.0)[..., None]
        found[f"{name} side bend"] = _arcsine(_dot(bone, frame[0]))[..., None]
    return found


def _elbow(at: _Places, side: str, _lower: tuple, _upper: tuple) -> np.ndarray:
    return _bend(*_limb(at, side, "shoulder", "elbow", "wrist"))


def _knee(at: _Places, side: str, lower: tuple, _upper: tuple) -> np.ndarray:
    """Below 0 where the shank leaves the thigh forwards."""
    thigh, shank = _limb(at, side, "hip", "knee", "ankle")
    turn = _dot(np.cross(thigh, shank), lower[0])
    return np.where(turn < 0, _arcsine(turn), _bend(thigh, shank))


def _hip_flexion(at: _Places, side: str, lower: tuple, _upper: tuple) -> np.ndarray:
    return _in_plane(_limb(at, side, "hip", "knee", "ankle")[0], lower, -1.0)


def _hip_abduction(at: _Places, side: str, lower: tuple, _upper: tuple) -> np.ndarray:
    outward = _dot(_limb(at, side, "hip", "knee", "ankle")[0], lower[0])
    return _arcsine(outward if side == "left" else -outward)


def _shoulder_extension(at: _Places, side: str, _lower: tuple, upper: tuple) -> np.ndarray:
    """How far the upper arm is behind the trunk; no limit where it is raised above the shoulder."""
    arm = _limb(at, side, "shoulder", "elbow", "wrist")[0]
    return np.where(_dot(arm, upper[1]) < 0, _arcsine(-_dot(arm, upper[2])), np.nan)


def _limb(at: _Places, side: str, *joints: str) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors of a limb's two bones."""
    top, middle, end = (at[f"{side}_{joint}"] for joint in joints)
    return _unit(middle - top), _unit(end - middle)


def _frame(left: np.ndarray, up: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors left, up (square to left) and forward."""
    left = _unit(left)
    up = _unit(up - _dot(up, left)[..., None] * left)
    return left, up, np.cross(left, up)


def _in_plane(bone: np.ndarray, frame: tuple, up_sign: float) -> np.ndarray:
    """Angle forward of up (or, with -1, of down) in the plane of up and forward; NaN for a bone nearly square to it."""
    forward, upward = _dot(bone, frame[2]), up_sign * _dot(bone, frame[1])
    return np.where(np.hypot(forward, upward) > 0.3, np.degrees(np.arctan2(forward, upward)), np.nan)


def _bend(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), _dot(one, other)))


def _arcsine(sine: np.ndarray) -> np.ndarray:
    return np.degrees(np.arcsin(np.clip(sine, -1, 1)))


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...c,...c->...", a, b)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
