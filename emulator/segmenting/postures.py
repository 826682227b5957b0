"""A take as points of posture space, and how fast it moves through it."""

from __future__ import annotations

import numpy as np

from emulator.clean import heading_rad, turn
from emulator.recordings.take import Take
from emulator.skeleton import Skeleton

FEWEST_FRAMES = 8
HALF_WINDOW_S = 0.1
"""A speed compares the mean posture of this time before with that after: tracking noise is averaged away."""


def postures(take: Take) -> np.ndarray:
    """Unit directions of all bones with the heading taken out, (T, 3 B): what place, size and turning leave alone.

    Raises ValueError that names the take and says what to do: markers, gaps, too few frames, a body that stands still.
    """
    if take.parents is None:
        raise ValueError(f"take {take.name}: found markers, expected joints: import with a marker set first")
    if take.n_frames < FEWEST_FRAMES:
        frames = f"{take.n_frames} frame{'s' if take.n_frames != 1 else ''}"
        raise ValueError(f"take {take.name}: found {frames}, expected {FEWEST_FRAMES} or more")
    gaps = np.argwhere(~np.isfinite(take.positions_m).all(axis=2))
    if len(gaps):
        frame, joint = (int(i) for i in gaps[0])
        where = f"the first at frame {frame}, {take.names[joint]}"
        raise ValueError(f"take {take.name}: found {len(gaps)} gaps ({where}), expected none: clean it first")
    skeleton = Skeleton(take.names, take.parents)
    try:
        heading = heading_rad(skeleton, take.positions_m)
        points = turn(skeleton.directions(take.positions_m), -heading[:, None]).reshape(take.n_frames, -1)
    except ValueError as error:
        raise ValueError(f"take {take.name}: {error}") from None
    if np.ptp(points, axis=0).max() < 1e-9:
        raise ValueError(f"take {take.name}: the body does not move, expected a movement to cut")
    return points


def smoothed(points: np.ndarray, half: int) -> np.ndarray:
    """Running means over 2 half + 1 frames, fewer at the ends; (T, m)."""
    if half < 1:
        return points
    sums = np.concatenate([np.zeros_like(points[:1]), np.cumsum(points, axis=0)])
    at = np.arange(len(points))
    low, high = np.maximum(at - half, 0), np.minimum(at + half + 1, len(points))
    shape = (-1, *[1] * (points.ndim - 1))
    return (sums[high] - sums[low]) / (high - low).reshape(shape)


def speed_per_s(points: np.ndarray, rate_hz: float) -> np.ndarray:
    """(T,) speed through posture space, what noise feigns (from third differences) taken off."""
    half = max(1, round(HALF_WINDOW_S * rate_hz))
    extended = np.pad(points, ((half, half), (0, 0)), mode="reflect", reflect_type="odd")
    sums = np.concatenate([np.zeros_like(extended[:1]), np.cumsum(extended, axis=0)])
    at = np.arange(len(points)) + half
    step = (sums[at + 1 + half] - sums[at + 1] - sums[at] + sums[at - half]) / half
    square = np.einsum("tm,tm->t", step, step) - 2 * noise_square(points) / half
    return np.sqrt(np.maximum(square, 0.0)) / (half + 1) * rate_hz


def noise_square(points: np.ndarray) -> float:
    """Variance of tracking noise, summed over the coordinates, from their third differences."""
    if len(points) < 4:
        return 0.0
    third = np.abs(np.diff(points, n=3, axis=0)) / np.sqrt(20.0)
    return float(np.sum((np.median(third, axis=0) / 0.6745) ** 2))


def typical_speed(speed: np.ndarray) -> float:
    """The mean speed over the way (not over time), which stillness does not change."""
    return float(np.sum(speed**2) / max(float(np.sum(speed)), 1e-300))
