"""Bridging: a joint's way across a few frames that are not to be had, by a spline that keeps the bone's length."""

from __future__ import annotations

import numpy as np

from emulator.recordings.take import Take

KNOTS = 4
"""Frames on either side that a spline goes through."""
ROUNDS = 40
"""Projections onto two bones come together linearly; this many leave less than noise."""


def spline(way_m: np.ndarray, first: int, last: int) -> np.ndarray:
    """Points (last - first + 1, 3) of a cubic spline (C2) through the seen frames of way_m (T, 3) on either side."""
    from scipy.interpolate import CubicSpline

    seen = np.isfinite(way_m).all(axis=-1)
    low = max(0, first - KNOTS)
    before = np.flatnonzero(seen[low:first]) + low
    after = np.flatnonzero(seen[last + 1 : last + 1 + KNOTS]) + last + 1
    knots = np.concatenate([before, after])
    return np.asarray(CubicSpline(knots, way_m[knots])(np.arange(first, last + 1)))


def bridge(take: Take, positions_m: np.ndarray, joint: int, first: int, last: int) -> np.ndarray:
    """The joint (last - first + 1, 3) across frames first to last of positions_m (T, J, 3), seen on both sides.

    A spline, held by its bones: across a turning bone a spline alone would cut the corner.
    """
    return held_by_bones(take, positions_m, joint, first, last, spline(positions_m[:, joint], first, last))


def held_by_bones(
    take: Take, positions_m: np.ndarray, joint: int, first: int, last: int, way_m: np.ndarray
) -> np.ndarray:
    """way_m (last - first + 1, 3) moved so that each bone to a joint that is seen goes over from its length before
    to that after; projections onto one bone after the other, the one to the parent last.
    """
    around, share = slice(first - 1, last + 2), np.linspace(0.0, 1.0, last - first + 3)[:, None]
    held = []
    for other in reversed(neighbours(take, joint)):
        bone = positions_m[around, joint] - positions_m[around, other]
        if np.isfinite(positions_m[around, other]).all():
            before, after = np.linalg.norm(bone[[0, -1]], axis=-1)
            held.append((positions_m[first : last + 1, other], (before + share * (after - before))[1:-1]))
    return onto_bones(way_m, held)


def onto_bones(way_m: np.ndarray, held: list[tuple[np.ndarray, np.ndarray]]) -> np.ndarray:
    """Points (T, 3) moved to the given lengths (T, 1) from the given centres (T, 3), the last exactly."""
    way = way_m
    for _ in range(ROUNDS if len(held) > 1 else 1):
        for centre, length in held:
            arm = way - centre
            now = np.linalg.norm(arm, axis=-1, keepdims=True)
            way = np.where(now > 1e-9, centre + arm * (length / np.where(now > 1e-9, now, 1.0)), way)
    return way


def neighbours(take: Take, joint: int) -> list[int]:
    """The joints at the other ends of its bones, the parent first; none where the points are markers."""
    parents = take.parents or (-1,) * len(take.names)
    return [j for j in (parents[joint],) if j >= 0] + [j for j, parent in enumerate(parents) if parent == joint]


def outwards(take: Take) -> list[int]:
    """Joint numbers, each parent before its children; as they are where the points are markers."""
    if take.parents is None:
        return list(range(len(take.names)))
    depth = [0] * len(take.names)
    for joint in range(len(take.names)):
        above = take.parents[joint]
        while above >= 0:
            depth[joint] += 1
            above = take.parents[above]
    return sorted(range(len(take.names)), key=lambda joint: depth[joint])
