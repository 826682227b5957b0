"""Decoding: coefficients of a posture model -> unit directions at any moments of the common clock, in blocks.

Between its points the clock's flat coordinates go along a cubic spline (twice differentiable), so that a joint's
acceleration does not jump at them. The spline is linear in the coordinates: its control points are those of the
components, made once, and a block is one matrix product and one pass. Of tangent coordinates the pass uses series, good
to 1e-14 for bones within 3.16 rad of their reference; a sequence beyond that is decoded by the numpy twin.

The way of the root in leg lengths, so that another body walks as far as its legs are long, and the heading.

The path is one of its own. In libraries of before it rides on the feet: if planted feet do not slide, the way of the
root follows from posture and bones, and what is left is small. But a running sum of what soft contacts say is rough,
what would cancel it is cut off with the last components, and a walk of 7 s ended 16 cm from where it was recorded.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import factorial

import numpy as np

from emulator.geometry.flattening import SHORTEST, SIEM, Flattening
from emulator.model.reduction import JointPCA
from emulator.motion import turn
from emulator.skeleton import Skeleton

LARGEST_TURN_RAD = 3.16
BLOCK_BYTES = 2**20
"""Control points held at a time: they should stay in the cache."""


@dataclass(frozen=True, eq=False)
class Decoder:
    """What decodes the coefficients (n, K) of a posture model."""

    posture: JointPCA
    flatten: Flattening

    @property
    def n_times(self) -> int:
        """Points of the common clock."""
        return self.posture.mean.size // self.flatten.n_channels

    def directions(
        self,
        coefficients: np.ndarray,
        place: np.ndarray,
        dtype: type[np.floating] | np.dtype = np.float64,
    ) -> np.ndarray:
        """Directions (n, S, B, 3) at places (n, S) of the common clock, in cells from 0 to T - 1.

        float32 agrees with float64 to about 1e-6.
        """
        out = np.empty((*place.shape, self.flatten.n_bones, 3), dtype)
        at_once = max(1, BLOCK_BYTES // ((self.n_times + 2) * self.flatten.n_channels * out.itemsize))
        for start in range(0, len(out), at_once):
            rows = slice(start, start + at_once)
            control = self.control(coefficients[rows], out.dtype)
            out[rows] = self.between(control, coefficients[rows], place[rows], out.dtype)
        return out

    def control(self, coefficients: np.ndarray, dtype: type[np.floating] | np.dtype = np.float64) -> np.ndarray:
        """Control points (n, T + 2, C) of the flat coordinates of coefficients (n, K)."""
        with_mean = np.concatenate([coefficients, np.ones((len(coefficients), 1))], axis=1).astype(dtype)
        return (with_mean @ self._basis[np.dtype(dtype)]).reshape(len(coefficients), self.n_times + 2, -1)

    def between(
        self,
        control: np.ndarray,
        coefficients: np.ndarray,
        place: np.ndarray,
        dtype: type[np.floating] | np.dtype = np.float64,
    ) -> np.ndarray:
        """As ``directions``, of control points (n, T + 2, C) that are at hand and the coefficients they are of."""
        from emulator.kernels.sphere import PITCH

        out = np.empty((*place.shape, self.flatten.n_bones, 3), dtype)
        if isinstance(self.flatten, SIEM) and self.flatten.n_bones > PITCH:
            out[:] = directions_numpy(self.posture, self.flatten, coefficients, place)
            return out
        far = self._decoded(control.astype(dtype, copy=False), place, out.reshape(*place.shape, -1))
        if np.any(far):
            out[far] = directions_numpy(self.posture, self.flatten, coefficients[far], place[far])
        return out

    def _decoded(self, control: np.ndarray, place: np.ndarray, to: np.ndarray) -> np.ndarray:
        """Directions to (n, S, 3B) of control points; which sequences (n,) are beyond what the series are good for."""
        from emulator.kernels.sphere import decode_block, decode_vectors

        number, beyond = control.dtype.type, np.zeros(len(control), dtype=np.int64)
        scratch = np.empty(control.shape[2] + 4, control.dtype)
        if isinstance(self.flatten, SIEM):
            wave, frame = self._series[control.dtype]
            decode_block(control, place, number(LARGEST_TURN_RAD**2), wave, frame, scratch, to, beyond)
        else:
            decode_vectors(control, place, number(SHORTEST), scratch, to)
        return beyond > 0

    @cached_property
    def _basis(self) -> dict[np.dtype, np.ndarray]:
        """For each type of number: control points of the components and the mean."""
        rows = np.concatenate([self.posture.basis, self.posture.mean[None]])
        basis = control_points(rows.reshape(len(rows), self.n_times, -1)).reshape(len(rows), -1)
        return {np.dtype(name): basis.astype(name) for name in ("float64", "float32")}

    @cached_property
    def _series(self) -> dict[np.dtype, tuple[np.ndarray, np.ndarray]]:
        """For each type of number: the series, and the bones' frames; of tangent coordinates only."""
        assert isinstance(self.flatten, SIEM)
        frame = _frame(self.flatten.reference)
        return {np.dtype(name): (_wave().astype(name), frame.astype(name)) for name in ("float64", "float32")}


def directions_numpy(posture: JointPCA, flatten: Flattening, coefficients: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The same as ``Decoder.directions`` in float64, sequence by sequence and without compiled code: the definition."""
    from scipy.interpolate import CubicSpline

    flat = posture.inverse(coefficients).reshape(len(coefficients), -1, flatten.n_channels)
    clock = np.arange(float(flat.shape[1]))
    along = [CubicSpline(clock, one)(at) for one, at in zip(flat, place)]
    return flatten.inverse(np.reshape(along, (*place.shape, flatten.n_channels)))


def control_points(values: np.ndarray) -> np.ndarray:
    """Control points (..., T + 2, C) of the cubic B-spline through values (..., T, C) on the points of the clock."""
    columns = np.moveaxis(values, -2, 0)
    control = _to_control(len(columns)) @ columns.reshape(len(columns), -1)
    return np.ascontiguousarray(np.moveaxis(control.reshape(-1, *columns.shape[1:]), 0, -2))


def along(control: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values (n, S, C) of the splines with control points (n, T + 2, C) at places (n, S), in cells."""
    from emulator.kernels.sphere import along_spline

    out, weight = np.empty((*place.shape, control.shape[-1])), np.empty(4)
    for one, at, to in zip(np.ascontiguousarray(control), place, out):
        along_spline(one, at, weight, to)
    return out


def places(warps: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Where moments own (n, S) of own unit time lie on the common clock of warps (n, T), in cells; ends are held."""
    from emulator.kernels.sphere import inverse_places

    place = np.empty(own.shape)
    inverse_places(np.ascontiguousarray(warps), np.ascontiguousarray(own, dtype=float), place)
    return place


@lru_cache(maxsize=8)
def _to_control(n_times: int) -> np.ndarray:
    """(T + 2, T) matrix from values to control points; the third derivative is continuous next to the ends.

    On one thread of BLAS: it is kept, and its last bits would depend on who asked for it first.
    """
    from threadpoolctl import threadpool_limits

    rows = np.zeros((n_times + 2, n_times + 2))
    for t in range(n_times):
        rows[t, t : t + 3] = np.array([1.0, 4.0, 1.0]) / 6.0
    rows[-2, :5] = rows[-1, -5:] = 1.0, -4.0, 6.0, -4.0, 1.0
    with threadpool_limits(1, user_api="blas"):
        return np.ascontiguousarray(np.linalg.inv(rows)[:, :n_times])


def _frame(reference: np.ndarray) -> np.ndarray:
    """(9 * PITCH,) matrices with the columns reference, first and second tangent axis of each bone, entry by entry."""
    from emulator.geometry import sphere
    from emulator.kernels.sphere import PITCH

    axes = np.concatenate([reference[:, None], sphere.basis(reference)], axis=1)
    frame = np.zeros((3, 3, PITCH))
    frame[..., : len(reference)] = axes.transpose(2, 1, 0)
    return frame.ravel()


@lru_cache(maxsize=1)
def _wave() -> np.ndarray:
    """(2, 8) Taylor coefficients of cos t and sin t / t in t squared."""
    return np.array([[(-1.0) ** k / factorial(2 * k + odd) for k in range(8)] for odd in (0, 1)])


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
        self, channel: np.ndarray, directions: np.ndarray, bone_length_m: np.ndarray, lowest_m: float = 0.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """Side channel (..., T, 4), directions (..., T, B, 3), bones (..., B) -> root_m (..., T, 3), yaw_rad (..., T).

        The path begins at x = y = 0, and no joint is ever below ``lowest_m``: a path kinks where a body would be.
        """
        from emulator.kernels.bodies import ride_all

        if not self._feet and lowest_m == -np.inf:  # nothing that a root would ride on or be lifted by
            root_m = channel[..., :3] * self.leg_m(bone_length_m)[..., None, None]
            root_m[..., :2] -= root_m[..., :1, :2].copy()
            return root_m, channel[..., 3]
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
            lowest_m,
            root_m.reshape(-1, n_times, 3),
        )
        return root_m, channel[..., 3]

    def inverse_numpy(
        self, channel: np.ndarray, directions: np.ndarray, bone_length_m: np.ndarray, lowest_m: float = 0.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """The same as ``inverse`` without compiled code."""
        yaw = channel[..., 3]
        length_m = bone_length_m[..., None, :]
        way, floor = self.ride(directions, length_m, yaw)
        left = channel[..., :3] * self.leg_m(bone_length_m)[..., None, None]
        level = way + left[..., :2]
        height = np.maximum(floor + left[..., 2], lowest_m - self._hanging(directions, length_m)[..., 2].min(-1))
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
