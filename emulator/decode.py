"""Decoding: coefficients of a posture model -> unit directions at any moments of the common clock, in blocks.

Between its points the clock's tangent coordinates go along a cubic spline (twice differentiable), so that a joint's
acceleration does not jump at them. The spline is linear in the coordinates: its control points are those of the
components, made once, and a block is one matrix product and one pass. The pass uses series, good to 1e-14 for bones
within 3.16 rad of their reference; a sequence beyond that is decoded by the numpy twin.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import factorial

import numpy as np

from emulator.flatten import SIEM
from emulator.reduce import JointPCA

LARGEST_TURN_RAD = 3.16
BLOCK_BYTES = 2**20
"""Control points held at a time: they should stay in the cache."""


@dataclass(frozen=True, eq=False)
class Decoder:
    """What decodes the coefficients (n, K) of a posture model: its components' control points and bones' frames."""

    posture: JointPCA
    flatten: SIEM

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
        from emulator.kernels.decode import PITCH, decode_block

        out = np.empty((len(coefficients), place.shape[1], len(self.flatten.reference), 3), dtype)
        if out.shape[2] > PITCH:
            out[:] = directions_numpy(self.posture, self.flatten, coefficients, place)
            return out
        basis, wave, frame = self._tables[out.dtype]
        limit, scratch = out.dtype.type(LARGEST_TURN_RAD**2), np.empty(self.flatten.n_channels + 4, out.dtype)
        at_once = max(1, BLOCK_BYTES // (basis.shape[1] * out.itemsize))
        for start in range(0, len(out), at_once):
            rows = slice(start, start + at_once)
            some = coefficients[rows]
            with_mean = np.concatenate([some, np.ones((len(some), 1))], axis=1).astype(out.dtype)
            control = (with_mean @ basis).reshape(len(some), self.n_times + 2, -1)
            beyond = np.zeros(len(some), dtype=np.int64)
            to = out[rows].reshape(*place[rows].shape, -1)
            decode_block(control, place[rows], limit, wave, frame, scratch, to, beyond)
            if np.any(beyond):
                far = beyond > 0
                out[rows][far] = directions_numpy(self.posture, self.flatten, some[far], place[rows][far])
        return out

    @cached_property
    def _tables(self) -> dict[np.dtype, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """For each type of number: control points of the components and the mean, the series, the bones' frames."""
        rows = np.concatenate([self.posture.basis, self.posture.mean[None]])
        basis = control_points(rows.reshape(len(rows), self.n_times, -1)).reshape(len(rows), -1)
        parts = basis, _wave(), _frame(self.flatten.reference)
        return {
            np.dtype(name): (parts[0].astype(name), parts[1].astype(name), parts[2].astype(name))
            for name in ("float64", "float32")
        }


def directions_numpy(posture: JointPCA, flatten: SIEM, coefficients: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The same as ``Decoder.directions`` in float64, sequence by sequence and without compiled code: the definition."""
    from scipy.interpolate import CubicSpline

    flat = posture.inverse(coefficients).reshape(len(coefficients), -1, flatten.n_channels)
    clock = np.arange(float(flat.shape[1]))
    along = [CubicSpline(clock, one)(at) for one, at in zip(flat, place)]
    return flatten.inverse(np.reshape(along, (*place.shape, flatten.n_channels)))


def control_points(values: np.ndarray) -> np.ndarray:
    """Control points (..., T + 2, C) of the cubic B-spline through values (..., T, C) on the points of the clock."""
    return np.asarray(_to_control(values.shape[-2]) @ values)


def along(control: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Values (n, S, C) of the splines with control points (n, T + 2, C) at places (n, S), in cells."""
    from emulator.kernels.decode import along_spline

    out, weight = np.empty((*place.shape, control.shape[-1])), np.empty(4)
    for one, at, to in zip(np.ascontiguousarray(control), place, out):
        along_spline(one, at, weight, to)
    return out


def places(warps: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Where moments own (n, S) of own unit time lie on the common clock of warps (n, T), in cells; ends are held."""
    from emulator.kernels.decode import inverse_places

    place = np.empty(own.shape)
    inverse_places(np.ascontiguousarray(warps), np.ascontiguousarray(own, dtype=float), place)
    return place


@lru_cache(maxsize=8)
def _to_control(n_times: int) -> np.ndarray:
    """(T + 2, T) matrix from values to control points; the third derivative is continuous next to the ends."""
    rows = np.zeros((n_times + 2, n_times + 2))
    for t in range(n_times):
        rows[t, t : t + 3] = np.array([1.0, 4.0, 1.0]) / 6.0
    rows[-2, :5] = rows[-1, -5:] = 1.0, -4.0, 6.0, -4.0, 1.0
    return np.ascontiguousarray(np.linalg.inv(rows)[:, :n_times])


def _frame(reference: np.ndarray) -> np.ndarray:
    """(9 * PITCH,) matrices with the columns reference, first and second tangent axis of each bone, entry by entry."""
    from emulator import sphere
    from emulator.kernels.decode import PITCH

    axes = np.concatenate([reference[:, None], sphere.basis(reference)], axis=1)
    frame = np.zeros((3, 3, PITCH))
    frame[..., : len(reference)] = axes.transpose(2, 1, 0)
    return frame.ravel()


@lru_cache(maxsize=1)
def _wave() -> np.ndarray:
    """(2, 8) Taylor coefficients of cos t and sin t / t in t squared."""
    return np.array([[(-1.0) ** k / factorial(2 * k + odd) for k in range(8)] for odd in (0, 1)])
