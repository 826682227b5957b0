"""Square-root velocity fields carried along warps."""

from __future__ import annotations

import numpy as np


def warped(fields: np.ndarray, warps: np.ndarray) -> np.ndarray:
    """(q o gamma) sqrt(gamma') of fields (N, cells, D), averaged exactly over each cell of the common clock.

    warps (N, T) on the common clock; the answer is (N, T - 1, D).
    """
    from emulator.kernels.fields import warp_field

    out = np.empty((len(fields), warps.shape[1] - 1, fields.shape[2]))
    for field, gamma, to in zip(np.ascontiguousarray(fields), np.ascontiguousarray(warps), out):
        warp_field(field, gamma, to)
    return out


def warped_numpy(fields: np.ndarray, warps: np.ndarray) -> np.ndarray:
    """The same as ``warped`` without compiled code, by differences of running sums."""
    rise = np.diff(warps, axis=-1)
    mean = np.stack([_mean_over(q, gamma) for q, gamma in zip(fields, warps)])
    return mean * np.sqrt(rise * rise.shape[1])[..., None]


def _mean_over(field: np.ndarray, gamma: np.ndarray) -> np.ndarray:
    """The mean of a step function (cells, D) over each interval between successive gamma: (T - 1, D)."""
    cells = len(field)
    area = np.concatenate([np.zeros((1, field.shape[1])), np.cumsum(field, axis=0)]) / cells
    low = np.minimum((gamma * cells).astype(int), cells - 1)
    share = (gamma * cells - low)[:, None]
    return np.diff(area[low] * (1.0 - share) + area[low + 1] * share, axis=0) / np.diff(gamma)[:, None]
