"""Poses of motion that goes on and on: directions without heading, and what the root does from one frame to the next.

Place and heading drop out, so that the tenth cycle has the same poses as the first; the path is the sum of the steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from emulator.clean import heading_rad, turn
from emulator.root import RootChannel
from emulator.skeleton import Skeleton

FLOOR_SHARE = 0.02
"""The floor lies at this quantile of the lowest joint of each frame."""


@dataclass(frozen=True, eq=False)
class Poses:
    """A stretch of motion without place and heading; leading axes are the batch.

    directions : (..., T, B, 3) unit directions in the heading frame of each frame (x forward, y left, z up)
    travel     : (..., T, 3) of the root to the NEXT frame: forward and to the left in legs a second, turning in radians
                 a second; in the heading frame of this frame; the last frame repeats the one before
    height     : (..., T) of the root above the floor, in legs
    """

    directions: np.ndarray
    travel: np.ndarray
    height: np.ndarray

    @property
    def n_frames(self) -> int:
        return int(self.directions.shape[-3])


def leg_length_m(skeleton: Skeleton, bone_length_m: np.ndarray) -> float:
    """Mean length of thigh and shank together; a quarter of all bones for a skeleton without legs."""
    return float(RootChannel(skeleton).leg_m(np.asarray(bone_length_m, float)))


def poses_of(positions_m: np.ndarray, skeleton: Skeleton, rate_hz: float, *, leg_m: float | None = None) -> Poses:
    """Joints (T, J, 3) through time -> Poses; ``leg_m`` by default from the median bones of these frames.

    Raises ValueError for fewer than 3 frames, and where the skeleton names a joint that is missing in a frame.
    """
    positions_m = np.asarray(positions_m, float)
    if len(positions_m) < 3:
        raise ValueError(f"poses need 3 frames, found {len(positions_m)}")
    leg_m = leg_m or leg_length_m(skeleton, np.median(skeleton.bone_lengths(positions_m), axis=0))
    directions = skeleton.directions(positions_m)
    yaw = heading_rad(skeleton, positions_m)
    root = positions_m[:, skeleton.root]
    step = turn(np.diff(root, axis=0), -yaw[:-1]) * rate_hz / leg_m
    travel = np.column_stack([step[:, :2], np.diff(yaw) * rate_hz])
    floor = np.quantile(positions_m[..., 2].min(axis=1), FLOOR_SHARE)
    return Poses(turn(directions, -yaw[:, None]), np.vstack([travel, travel[-1:]]), (root[:, 2] - floor) / leg_m)


def path_of(
    poses: Poses,
    leg_m: float | np.ndarray,
    rate_hz: float,
    *,
    start_xy_m: Sequence[float] = (0.0, 0.0),
    start_yaw_rad: float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Where the travel leads: root_m (..., T, 3) and yaw_rad (..., T), from the start given. Inverse of ``poses_of``.

    leg_m : metres, (...) or one number
    """
    travel = np.asarray(poses.travel, float)
    yaw = _summed(travel[..., 2] / rate_hz) + start_yaw_rad
    leg = np.asarray(leg_m, float)[..., None]
    steps = np.stack([travel[..., 0] * leg, travel[..., 1] * leg, np.zeros_like(yaw)], axis=-1) / rate_hz
    level = turn(steps, yaw)[..., :2]
    x, y = _summed(level[..., 0]) + start_xy_m[0], _summed(level[..., 1]) + start_xy_m[1]
    return np.stack([x, y, poses.height * leg], axis=-1), yaw


def positions_of(
    poses: Poses, skeleton: Skeleton, bone_length_m: np.ndarray, rate_hz: float, *, leg_m: float | None = None
) -> np.ndarray:
    """Joints (..., T, J, 3) in metres of a body with bones (B,) on the path of the poses; starts at the origin."""
    root_m, yaw = path_of(poses, leg_m or leg_length_m(skeleton, bone_length_m), rate_hz)
    return skeleton.positions(turn(poses.directions, yaw[..., None]), bone_length_m, root_m)


def _summed(steps: np.ndarray) -> np.ndarray:
    """Sums of the steps before each frame, (..., T): the first is 0."""
    total = np.cumsum(steps, axis=-1)
    return np.concatenate([np.zeros_like(total[..., :1]), total[..., :-1]], axis=-1)
