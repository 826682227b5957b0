"""Where a movement rests: stillness, and the posture that it comes back to."""

from __future__ import annotations

import numpy as np

STILL_SHARE = 0.13
"""Slower than this share of the take's typical speed is still."""
SHORTEST_S = 0.15
"""A rest lasts at least this long."""
MOST_FRAMES = 1200
"""So many frames are looked at for the posture where most of them are."""
NEAR_SHARE = 0.15
"""Postures are near within this share of the take's span."""


def still_frames(speed: np.ndarray, typical: float, rate_hz: float) -> np.ndarray:
    """(T,) whether the body is still: slow, for SHORTEST_S at least; shorter stirs in between do not count."""
    from scipy.ndimage import binary_closing, binary_opening

    size = max(1, round(SHORTEST_S * rate_hz))
    slow = np.pad(speed < STILL_SHARE * typical, size, mode="edge")
    open_ones = binary_opening(binary_closing(slow, np.ones(max(1, size // 2))), np.ones(size))
    return np.asarray(open_ones[size:-size] & (speed < 2 * STILL_SHARE * typical))


def home_posture(points: np.ndarray, still: np.ndarray) -> np.ndarray:
    """The posture (m,) where the body rests most; where it is never still, the one that it is nearest to most often.

    Of several resting places one counts more in which the take begins or ends.
    """
    frames = np.flatnonzero(still) if still.any() else np.arange(len(points))
    frames = frames[np.linspace(0, len(frames) - 1, min(len(frames), MOST_FRAMES)).astype(int)]
    chosen = points[frames]
    from scipy.spatial.distance import cdist

    near = cdist(chosen, chosen) < NEAR_SHARE * span(points)
    share = near.mean(axis=1)
    for end in (0, -1):
        share = share + 0.25 * (np.linalg.norm(chosen - points[end], axis=1) < NEAR_SHARE * span(points))
    best = int(np.argmax(share))
    return np.asarray(chosen[near[best]].mean(axis=0))


def span(points: np.ndarray) -> float:
    """How far postures (T, m) lie apart: twice the 95th percentile of the distance from their median."""
    away = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    return 2.0 * float(np.quantile(away, 0.95))
