"""Orthonormal frames of tangent planes, and vectors in their coordinates."""

from __future__ import annotations

import numpy as np

from emulator import sphere


def coordinates(tangent: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """Tangent vectors (..., B, 3) -> (..., 2B) in frames (..., B, 2, 3)."""
    pairs = np.stack([np.einsum("...bc,...bc->...b", tangent, plane[..., k, :]) for k in (0, 1)], axis=-1)
    return pairs.reshape(*pairs.shape[:-2], -1)


def vectors(flat: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """Coordinates (..., 2B) in frames (..., B, 2, 3) -> tangent vectors (..., B, 3)."""
    pairs = flat.reshape(*flat.shape[:-1], -1, 2)
    return pairs[..., :1] * plane[..., 0, :] + pairs[..., 1:] * plane[..., 1, :]


def carried(plane: np.ndarray, base: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Frames (..., B, 2, 3) at ``base`` carried in parallel to ``target``, both (..., B, 3), in one hop."""
    return sphere.transport(base[..., None, :], target[..., None, :], plane)


def along(directions: np.ndarray, plane: np.ndarray) -> np.ndarray:
    """A frame (..., B, 2, 3) at the first posture carried from posture to posture: (n, T, B, 2, 3) of (n, T, B, 3).

    Raises ValueError where two successive postures are opposite.
    """
    frames = np.empty((*directions.shape[:-1], 2, 3))
    frames[:, 0] = plane
    for t in range(1, directions.shape[1]):
        frames[:, t] = carried(frames[:, t - 1], directions[:, t - 1], directions[:, t])
    return frames
