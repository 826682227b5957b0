"""Decoding: coefficients of a posture model -> unit directions at any moments of the common clock, in blocks.

A block is one matrix product and three passes over a few sequences at a time, so that nothing but the answer is large.
The passes use series, good to 1e-14 for bones within 3.16 rad of their reference that turn less than 0.3 rad between
two points of the common clock; a sequence beyond that is decoded by the numpy twin.
"""

from __future__ import annotations

from functools import lru_cache
from math import factorial

import numpy as np

from emulator import sphere
from emulator.flatten import SIEM
from emulator.geodesic import LARGEST_STEP_RAD, series
from emulator.reduce import JointPCA

LARGEST_TURN_RAD = 3.16
BLOCK_BYTES = 2**20
"""Tangent coordinates held at a time: they should stay in the cache."""


def directions(
    posture: JointPCA,
    flatten: SIEM,
    coefficients: np.ndarray,
    place: np.ndarray,
    dtype: type[np.floating] | np.dtype = np.float64,
) -> np.ndarray:
    """Directions (n, S, B, 3) of coefficients (n, K) at places (n, S) of the common clock, in cells from 0 to T - 1.

    Between two points of the clock a bone moves along the geodesic. float32 agrees with float64 to about 1e-6.
    Raises ValueError where a bone points opposite at two successive points of the clock.
    """
    from emulator.kernels.decode import PITCH

    n, n_bones = len(coefficients), len(flatten.reference)
    out = np.empty((n, place.shape[1], n_bones, 3), dtype)
    per_sequence = posture.mean.size * out.itemsize
    at_once = max(1, BLOCK_BYTES // per_sequence)
    fill = _Block(posture, flatten, out.dtype, at_once) if n_bones <= PITCH else None
    for start in range(0, n, at_once):
        rows = slice(start, start + at_once)
        if fill is None:
            out[rows] = directions_numpy(posture, flatten, coefficients[rows], place[rows])
        else:
            fill(coefficients[rows], place[rows], out[rows])
    return out


def directions_numpy(posture: JointPCA, flatten: SIEM, coefficients: np.ndarray, place: np.ndarray) -> np.ndarray:
    """The same as ``directions`` in float64, all at once and without compiled code: the definition."""
    flat = posture.inverse(coefficients)
    aligned = flatten.inverse(flat.reshape(len(flat), -1, flatten.n_channels))
    rows, cell = np.arange(len(place))[:, None], np.minimum(place.astype(int), aligned.shape[1] - 2)
    return sphere.between(aligned[rows, cell], aligned[rows, cell + 1], (place - cell)[..., None])


def places(warps: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Where moments own (n, S) of own unit time lie on the common clock of warps (n, T), in cells; ends are held."""
    from emulator.kernels.decode import inverse_places

    place = np.empty(own.shape)
    inverse_places(np.ascontiguousarray(warps), np.ascontiguousarray(own, dtype=float), place)
    return place


class _Block:
    """The buffers and tables of one call of ``directions``."""

    def __init__(self, posture: JointPCA, flatten: SIEM, dtype: np.dtype, at_once: int) -> None:
        self.posture, self.flatten = posture, flatten
        self.basis = np.concatenate([posture.basis, posture.mean[None]]).astype(dtype)
        self.limits = np.array([LARGEST_TURN_RAD**2, LARGEST_STEP_RAD**2], dtype)
        self.tables = _wave().astype(dtype), _frame(flatten.reference, dtype), series()
        self.coordinates = np.empty((at_once, posture.mean.size), dtype)
        self.points = np.empty((3, posture.mean.size // 2), dtype)

    def __call__(self, coefficients: np.ndarray, place: np.ndarray, out: np.ndarray) -> None:
        from emulator.kernels.decode import decode_block

        with_mean = np.concatenate([coefficients, np.ones((len(coefficients), 1))], axis=1).astype(out.dtype)
        flat = np.matmul(with_mean, self.basis, out=self.coordinates[: len(coefficients)])
        beyond = np.zeros(len(flat), dtype=np.int64)
        decode_block(flat, place, self.limits, *self.tables, self.points, out.reshape(*place.shape, -1), beyond)
        if np.any(beyond):
            far = beyond > 0
            out[far] = directions_numpy(self.posture, self.flatten, coefficients[far], place[far])


def _frame(reference: np.ndarray, dtype: np.dtype) -> np.ndarray:
    """(9 * PITCH,) matrices with the columns reference, first and second tangent axis of each bone, entry by entry."""
    from emulator.kernels.decode import PITCH

    axes = np.concatenate([reference[:, None], sphere.basis(reference)], axis=1)
    frame = np.zeros((3, 3, PITCH), dtype)
    frame[..., : len(reference)] = axes.transpose(2, 1, 0)
    return frame.ravel()


@lru_cache(maxsize=1)
def _wave() -> np.ndarray:
    """(2, 8) Taylor coefficients of cos t and sin t / t in t squared."""
    return np.array([[(-1.0) ** k / factorial(2 * k + odd) for k in range(8)] for odd in (0, 1)])
