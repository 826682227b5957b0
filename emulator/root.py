"""The way of the root in leg lengths, so that another body walks as far as its legs are long, and the heading.

The path is one of its own. In libraries of before it rides on the feet: if planted feet do not slide, the way of the
root follows from posture and bones, and what is left is small. But a running sum of what soft contacts say is rough,
what would cancel it is cut off with the last components, and a walk of 7 s ended 16 cm from where it was recorded.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from emulator.clean import turn
from emulator.skeleton import Skeleton

SOFT_M = 0.01
"""Feet within about this height of the lowest share the support."""
_FEET = ("left_ankle", "left_toe", "right_ankle", "right_toe")
_LEGS = ("left_knee", "left_ankle", "right_knee", "right_ankle")


@dataclass(frozen=True)
class RootChannel:
    """Side channel (..., T, 4): slip x, slip y and clearance in leg lengths, heading in radians; for one skeleton.

    Where nothing rides, and on a skeleton without feet, it is the whole path.
    """

    skeleton: Skeleton
    rides: bool = False

    def leg_m(self, bone_length_m: np.ndarray) -> np.ndarray:
        """Mean length of a leg (thigh and shank), (..., B) -> (...); a quarter of all bones where no knees are."""
        names = self.skeleton.bone_names
        bones = [names.index(name) for name in _LEGS if name in names]
        chosen = bone_length_m[..., bones].sum(-1) / 2 if len(bones) == 4 else bone_length_m.sum(-1) / 4
        return np.asarray(chosen)

    def forward(
        self,
        directions: np.ndarray,
        bone_length_m: np.ndarray,
        root_m: np.ndarray,
        yaw_rad: np.ndarray,
    ) -> np.ndarray:
        """Directions (T, B, 3) without heading, bones (B,), path (T, 3), heading (T,) -> side channel (T, 4)."""
        way, floor = self.ride(directions, bone_length_m[..., None, :], yaw_rad)
        left = np.stack([root_m[..., 0] - way[..., 0], root_m[..., 1] - way[..., 1], root_m[..., 2] - floor], axis=-1)
        return np.concatenate([left / self.leg_m(bone_length_m)[..., None, None], yaw_rad[..., None]], axis=-1)

    def inverse(
        self, channel: np.ndarray, directions: np.ndarray, bone_length_m: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Side channel (..., T, 4), directions (..., T, B, 3), bones (..., B) -> root_m (..., T, 3), yaw_rad (..., T).

        The path begins at x = y = 0, and no joint is ever below the floor.
        """
        from emulator.kernels.body import ride_all

        n_times, n_bones = directions.shape[-3:-1]
        root_m = np.empty((*channel.shape[:-1], 3))
        ride_all(
            np.ascontiguousarray(directions, dtype=float).reshape(-1, n_times, 3 * n_bones),
            np.asarray(bone_length_m, dtype=float).reshape(-1, n_bones),
            self.skeleton.chain,
            np.array(self._feet, dtype=np.int64),
            SOFT_M,
            channel.reshape(-1, n_times, 4),
            self.leg_m(np.asarray(bone_length_m)).reshape(-1),
            root_m.reshape(-1, n_times, 3),
        )
        return root_m, channel[..., 3]

    def inverse_numpy(
        self, channel: np.ndarray, directions: np.ndarray, bone_length_m: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same as ``inverse`` without compiled code."""
        yaw = channel[..., 3]
        length_m = bone_length_m[..., None, :]
        way, floor = self.ride(directions, length_m, yaw)
        left = channel[..., :3] * self.leg_m(bone_length_m)[..., None, None]
        level = way + left[..., :2]
        height = np.maximum(floor + left[..., 2], -self._hanging(directions, length_m)[..., 2].min(-1))
        return np.concatenate([level - level[..., :1, :], height[..., None]], axis=-1), yaw

    @property
    def _feet(self) -> list[int]:
        feet = _FEET if self.rides else ()
        return [self.skeleton.names.index(name) for name in feet if name in self.skeleton.names]

    def _hanging(self, directions: np.ndarray, length_m: np.ndarray) -> np.ndarray:
        """Joints (..., T, J, 3) with the root at the origin; lengths (..., T or 1, B)."""
        zero = np.zeros((*directions.shape[:-2], 3))
        return self.skeleton.positions(directions, length_m, zero)

    def ride(self, directions: np.ndarray, length_m: np.ndarray, yaw_rad: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The horizontal way (..., T, 2) on planted feet, and the height (..., T) with the lowest foot at 0.

        directions (..., T, B, 3) without heading, lengths (..., T or 1, B), heading (..., T).
        """
        feet = self._feet
        if not feet:
            return np.zeros((*yaw_rad.shape, 2)), np.zeros(yaw_rad.shape)
        hanging = turn(self._hanging(directions, length_m)[..., feet, :], yaw_rad[..., None])
        above = hanging[..., 2] - hanging[..., 2].min(-1, keepdims=True)
        weight = np.exp(-above / SOFT_M)
        floor = -hanging[..., 2].min(-1) + SOFT_M * np.log(weight.mean(-1))
        share = weight / weight.sum(-1, keepdims=True)
        both = share[..., 1:, :] + share[..., :-1, :]
        step = -0.5 * np.einsum("...f,...fc->...c", both, np.diff(hanging[..., :2], axis=-3))
        start = np.zeros((*step.shape[:-2], 1, 2))
        return np.concatenate([start, np.cumsum(step, axis=-2)], axis=-2), floor
