"""The body's own axes, and the trunk's. z is up; what has no direction is nan, never a direction of its own."""

from collections.abc import Sequence

import numpy as np

from opsim.ergonomics.joints import joints_m

SHORTEST_M = 1e-6
"""What is shorter has no direction."""


def body_frame(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Axes of the body, (..., J, 3) -> (..., 3, 3): rows x forward, y left along the levelled hip line, z up.

    x = y cross up. nan where the hip line is vertical: nobody can say then what is forward.
    """
    left_hip, right_hip = joints_m(positions_m, names, "left_hip", "right_hip")
    across = left_hip - right_hip
    left = unit(across * np.array([1.0, 1.0, 0.0]))
    up = np.broadcast_to([0.0, 0.0, 1.0], left.shape)
    return np.stack([np.cross(left, up), left, up + 0.0 * left], axis=-2)


def trunk_frame(positions_m: np.ndarray, names: Sequence[str]) -> np.ndarray:
    """Axes of the trunk, (..., J, 3) -> (..., 3, 3): rows x forward, y left along the shoulders, z from pelvis to neck.

    The shoulder line is made square to the trunk. nan where the trunk has no length or the shoulders lie along it.
    """
    pelvis, neck = joints_m(positions_m, names, "pelvis", "neck")
    left, right = joints_m(positions_m, names, "left_shoulder", "right_shoulder")
    along, across = unit(neck - pelvis), left - right
    side = unit(across - _dot(across, along)[..., None] * along)
    return np.stack([np.cross(side, along), side, along], axis=-2)


def in_frame(frame: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) in the axes that are the rows of ``frame`` (..., 3, 3)."""
    return np.einsum("...ij,...j->...i", frame, vectors)


def unit(vectors: np.ndarray) -> np.ndarray:
    """Vectors (..., 3) at length 1; nan where shorter than ``SHORTEST_M``."""
    lengths = np.sqrt(_dot(vectors, vectors))[..., None]
    return vectors / np.where(lengths >= SHORTEST_M, lengths, np.nan)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)
