"""Joint angles from joint positions, and turning what lies beyond a joint to change one."""

from __future__ import annotations

import numpy as np

from emulator.cleaning.limits import Limit
from emulator.recordings.take import Take

MOST_OVER_DEG = 60.0
"""A knee that seems further over is a bent one with a foot that points the wrong way."""


def angle_deg(take: Take, limit: Limit) -> tuple[np.ndarray, np.ndarray]:
    """The angle (T,) in degrees that a limit speaks of, and the unit axis (T, 3) about which turning enlarges it.

    nan where it cannot be told: a bone without length, an axis without direction, a body without hips.
    """
    near, far = (_unit(_bone(take, *pair)) for pair in (limit.bones[:2], limit.bones[2:]))
    if limit.kind == "behind":
        return _behind(take, far)
    axis = np.cross(near, far)
    bend = np.degrees(np.arctan2(np.linalg.norm(axis, axis=-1), np.sum(near * far, axis=-1)))
    axis = _unit(axis)
    if limit.kind == "over":
        return _over(take, limit, near, bend, axis)
    return bend, axis


def neutral_deg(takes: list[Take], limit: Limit) -> float:
    """What an angle is when a person stands: its median over the first frames of the takes; 0 but for a lift."""
    if limit.kind != "lift":
        return 0.0
    return float(np.nanmedian([angle_deg(take, limit)[0][0] for take in takes]))


def turned(take: Take, joint: str, far: str, axis: np.ndarray, by_deg: np.ndarray) -> np.ndarray:
    """Positions (T, J, 3) with all that hangs on ``far`` turned about ``joint`` by by_deg (T,) about axis (T, 3)."""
    assert take.parents is not None
    centre = take.positions_m[:, [take.names.index(joint)]]
    moved = beyond(take, far)
    positions = take.positions_m.copy()
    arm = positions[:, moved] - centre
    angle = np.radians(np.where(np.isfinite(by_deg), by_deg, 0.0))[:, None, None]
    axis = np.where(np.isfinite(axis), axis, 0.0)[:, None, :]
    along = axis * np.sum(axis * arm, axis=-1, keepdims=True)
    turned_arm = along + np.cos(angle) * (arm - along) + np.sin(angle) * np.cross(axis, arm)  # Rodrigues
    positions[:, moved] = np.where(by_deg[:, None, None] != 0, centre + turned_arm, positions[:, moved])
    return positions


def beyond(take: Take, far: str) -> list[int]:
    """The joint ``far`` and all that hang on it."""
    assert take.parents is not None
    inside = {take.names.index(far)}
    while len(inside) < len(more := inside | {j for j, parent in enumerate(take.parents) if parent in inside}):
        inside = more
    return sorted(inside)


def _bone(take: Take, start: str, end: str) -> np.ndarray:
    return take.positions_m[:, take.names.index(end)] - take.positions_m[:, take.names.index(start)]


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(length > 1e-9, vectors / np.where(length > 1e-9, length, 1.0), np.nan)


def _over(
    take: Take, limit: Limit, near: np.ndarray, bend: np.ndarray, axis: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The bend, positive where it goes against the way a knee bends, which the foot shows."""
    toe = limit.far.replace("ankle", "toe")
    if toe not in take.names:
        return np.full(len(bend), np.nan), axis
    shin = _unit(_bone(take, *limit.bones[2:]))
    foot = _bone(take, limit.far, toe)
    foot = foot - shin * np.sum(foot * shin, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        # in a bent knee the thigh points to where the foot does; a knee so far over has a foot that points wrongly
        against = (np.sum(near * foot, axis=-1) < 0) & (bend < MOST_OVER_DEG)
    return np.where(against, bend, -bend), np.where(against[:, None], axis, -axis)


def _behind(take: Take, arm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far the upper arm points behind the trunk, in degrees; the trunk looks along hips cross spine."""
    if not {"left_hip", "right_hip", "pelvis", "neck"} <= set(take.names):
        return np.full(len(arm), np.nan), np.full(arm.shape, np.nan)
    back = -_unit(np.cross(_bone(take, "right_hip", "left_hip"), _bone(take, "pelvis", "neck")))
    sine = np.clip(np.sum(arm * back, axis=-1), -1.0, 1.0)
    return np.degrees(np.arcsin(sine)), _unit(np.cross(arm, back))
