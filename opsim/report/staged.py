"""Performances made ready to be looked at side by side, each by the same steps, so that only the movement differs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

RATE_HZ = 30.0
"""Frames a second of what is shown."""
FLOOR_QUANTILE = 0.1
"""The floor lies under the lowest joint, where it is this low or lower in this share of the frames."""


@dataclass(frozen=True, eq=False)
class Card:
    """One performance to look at: ``positions_m`` (T, J, 3) at RATE_HZ, recorded or not, and who it is, in words."""

    positions_m: np.ndarray
    is_real: bool
    who: str

    @property
    def duration_s(self) -> float:
        return (len(self.positions_m) - 1) / RATE_HZ


def staged(positions_m: np.ndarray, rate_hz: float, skeleton: Any) -> np.ndarray:
    """Joints (T, J, 3) at ``rate_hz`` as a Card has them: RATE_HZ, first root at x = y = 0, first heading along x.

    The lowest joint stands on z = 0. Bodies keep the sizes they have.
    """
    shown = resampled(np.asarray(positions_m, float), rate_hz)
    start = shown[0, skeleton.parents.index(-1), :2]
    shown = _turned(shown - np.append(start, 0.0), -_heading_rad(shown[0], skeleton.names))
    shown[..., 2] -= np.quantile(shown[..., 2].min(axis=1), FLOOR_QUANTILE)
    return shown


def resampled(positions_m: np.ndarray, rate_hz: float) -> np.ndarray:
    """(T, J, 3) at ``rate_hz`` -> (T', J, 3) at RATE_HZ, linear between frames; the end to half a frame."""
    duration_s = (len(positions_m) - 1) / rate_hz
    time_s = np.arange(max(round(duration_s * RATE_HZ), 1) + 1) / RATE_HZ
    place = np.minimum(time_s * rate_hz, len(positions_m) - 1.0)
    low = np.minimum(place.astype(int), len(positions_m) - 2)
    share = (place - low)[:, None, None]
    return (1 - share) * positions_m[low] + share * positions_m[low + 1]


def _heading_rad(posture_m: np.ndarray, names: Sequence[str]) -> float:
    """Where one posture (J, 3) looks: across its hip line, 0 along x; 0 for a skeleton without hips."""
    if not {"left_hip", "right_hip"} <= set(names):
        return 0.0
    left = posture_m[list(names).index("left_hip")] - posture_m[list(names).index("right_hip")]
    return float(np.arctan2(-left[0], left[1]))


def _turned(points: np.ndarray, angle_rad: float) -> np.ndarray:
    """Points (..., 3) turned about the vertical, x towards y."""
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    return points @ np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
