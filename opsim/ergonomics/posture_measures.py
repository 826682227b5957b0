"""The measures of postures from the positions of joints, by ``angles.py``: the definition, written to be read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from opsim.ergonomics import angles
from opsim.ergonomics.columns import AT, COLUMNS
from opsim.ergonomics.frames import body_frame, in_frame, trunk_frame, unit
from opsim.ergonomics.joints import CANONICAL, SIDES, both_sides_m, joints_m
from opsim.ergonomics.options import USUAL, Options

OWN_SIDE = np.array([1.0, -1.0])
"""Which way along y the own side lies, of left and right."""
FEET = ("left_ankle", "right_ankle", "left_toe", "right_toe")


def measures_of_positions(
    positions_m: np.ndarray, names: Sequence[str], options: Options = USUAL, neck_neutral_rad: float = 0.0
) -> np.ndarray:
    """Joints (..., J, 3) in metres, z up, named by ``names`` (J,) -> measures (..., COLUMNS) as ``columns.py`` says.

    A measure is nan where the skeleton lacks a joint it needs, or a posture does not have it. In lengths the wrist
    stands for a hand that is missing; the floor is the lowest of the ankles and toes that there are: without toes it
    is as high as an ankle (``missing_scores`` says so).
    Raises ValueError where positions are not (..., J, 3), or for an unknown reference of arms.
    """
    body = _canonical(np.asarray(positions_m, dtype=float), names)
    out = np.empty((*body.shape[:-2], len(COLUMNS)))
    for name, values in {**_angles_deg(body, options, neck_neutral_rad), **_lengths_m(body)}.items():
        out[..., AT[name]] = values
    return out


def _canonical(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """(..., 21, 3) the joints that measures are made of; nan where a joint is missing."""
    here = [name for name in CANONICAL if name in names]
    found = np.full((*positions_m.shape[:-2], len(CANONICAL), 3), np.nan)
    for name, joint_m in zip(here, joints_m(positions_m, names, *here)):
        found[..., CANONICAL.index(name), :] = joint_m
    return found


def _angles_deg(body: np.ndarray, options: Options, neck_neutral_rad: float) -> dict[str, np.ndarray]:
    trunk = angles.trunk_angles(body, CANONICAL)
    neck = angles.neck_angles(body, CANONICAL, neck_neutral_rad)
    arms = angles.upper_arm_angles(body, CANONICAL, options.arm_reference)
    found = {"trunk_flexion": trunk.flexion_rad, "trunk_side": trunk.side_bend_rad, "trunk_twist": trunk.twist_rad}
    found |= {"neck_flexion": neck.flexion_rad, "neck_side": neck.side_bend_rad}
    found |= _sided("arm_flexion", arms.flexion_rad) | _sided("arm_abduction", arms.abduction_rad)
    found |= _sided("arm_elevation", _elevation_rad(body))
    found |= _sided("elbow", angles.elbow_bend_rad(body, CANONICAL))
    found |= _sided("wrist", angles.wrist_bend_rad(body, CANONICAL))
    found |= _sided("knee", angles.knee_bend_rad(body, CANONICAL))
    return {name: np.rad2deg(angle) for name, angle in found.items()}


def _lengths_m(body: np.ndarray) -> dict[str, np.ndarray]:
    shoulder, elbow, wrist, hand, ankle = (
        both_sides_m(body, CANONICAL, joint) for joint in ("shoulder", "elbow", "wrist", "hand", "ankle")
    )
    hand = np.where(np.isnan(hand).any(axis=-1, keepdims=True), wrist, hand)
    pelvis, neck, *feet = joints_m(body, CANONICAL, "pelvis", "neck", *FEET)
    floor_m = np.fmin.reduce([foot[..., 2] for foot in feet])
    trunk = trunk_frame(body, CANONICAL)[..., None, :, :]
    outside = in_frame(trunk, hand - shoulder)[..., 1] * OWN_SIDE
    across = -in_frame(trunk, hand - neck[..., None, :])[..., 1] * OWN_SIDE
    reach = in_frame(body_frame(body, CANONICAL), (hand.mean(axis=-2) - ankle.mean(axis=-2)))
    found = _sided("elbow_above_m", elbow[..., 2] - shoulder[..., 2])
    found |= _sided("across_m", across) | _sided("outside_m", outside)
    found |= _sided("hand_up_m", hand[..., 2] - floor_m[..., None])
    found |= {"hands_forward_m": reach[..., 0], "hands_left_m": reach[..., 1]}
    return found | _sided("ankle_up_m", ankle[..., 2] - floor_m[..., None]) | {"pelvis_up_m": pelvis[..., 2] - floor_m}


def _elevation_rad(body: np.ndarray) -> np.ndarray:
    """(..., 2) of the upper arms against gravity; no heading is asked for, so hips do not matter."""
    shoulder, elbow = (both_sides_m(body, CANONICAL, joint) for joint in ("shoulder", "elbow"))
    u = unit(elbow - shoulder)
    return np.arctan2(np.hypot(u[..., 0], u[..., 1]), -u[..., 2])


def _sided(name: str, both: np.ndarray) -> dict[str, np.ndarray]:
    """Of (..., 2), by the names of both sides."""
    return {f"{side}_{name}": both[..., place] for place, side in enumerate(SIDES)}
