"""Bodies put together by hand: a standing person of the canonical joints, bent by rotations."""

import numpy as np

from opsim.ergonomics.angles import CANONICAL

STANDING = {
    "pelvis": (0, 0, 0.95), "spine": (0, 0, 1.1), "chest": (0, 0, 1.25), "neck": (0, 0, 1.45), "head": (0, 0, 1.65),
    "left_shoulder": (0, 0.2, 1.4), "left_elbow": (0, 0.2, 1.1), "left_wrist": (0, 0.2, 0.85),
    "left_hand": (0, 0.2, 0.76), "left_hip": (0, 0.1, 0.95), "left_knee": (0, 0.1, 0.5), "left_ankle": (0, 0.1, 0.07),
    "left_toe": (0.2, 0.1, 0.02),
}  # fmt: skip
ARM = ("elbow", "wrist", "hand")
ABOVE_THE_HIPS = [
    name for name in CANONICAL if not any(low in name for low in ("pelvis", "hip", "knee", "ankle", "toe"))
]


def standing():
    """(21, 3) metres, upright, looking along x, arms hanging."""
    right = {name.replace("left", "right"): (x, -y, z) for name, (x, y, z) in STANDING.items() if "left" in name}
    return np.array([{**STANDING, **right}[name] for name in CANONICAL], dtype=float)


def turn(axis, degrees):
    """The rotation (3, 3) about an axis by the right-hand rule."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.deg2rad(degrees)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def moved(body, rotation, about, joints):
    """The body with some joints turned about another."""
    body, centre = body.copy(), body[CANONICAL.index(about)]
    rows = [CANONICAL.index(name) for name in joints]
    body[rows] = (body[rows] - centre) @ rotation.T + centre
    return body


def bent(flexion=0.0, side=0.0, twist=0.0, body=None):
    """Bent at the hips: twisted about the trunk first, then brought by the smallest rotation to v of these angles.

    flexion, side : degrees of v as design.md defines them, side to the left
    """
    body = standing() if body is None else body
    f, s = np.deg2rad([flexion, side])
    v = np.array([np.cos(s) * np.sin(f), np.sin(s), np.cos(s) * np.cos(f)])
    axis = np.cross([0, 0, 1.0], v)
    lean = np.eye(3) if np.linalg.norm(axis) < 1e-12 else turn(axis, np.rad2deg(np.arccos(np.clip(v[2], -1, 1))))
    return moved(body, lean @ turn([0, 0, 1], twist), "pelvis", ABOVE_THE_HIPS)


def arm(body, side, rotation):
    """The whole arm of a side turned about its shoulder."""
    return moved(body, rotation, f"{side}_shoulder", [f"{side}_{joint}" for joint in ARM])


def mirrored(body):
    """The mirror image: what was left is right."""
    other = [name.replace("left", "*").replace("right", "left").replace("*", "right") for name in CANONICAL]
    return body[..., [CANONICAL.index(name) for name in other], :] * np.array([1.0, -1.0, 1.0])
