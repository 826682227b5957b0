"""Feet on the floor: when they are planted, how far they stray and slide, and how deep anything sinks.

Where the centre of mass is over the feet that carry it: a body's segments, and the polygon of the planted joints.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from scipy.ndimage import gaussian_filter1d

from emulator.geometry.centre_of_mass import centre_of_mass_m
from emulator.judge.clips import Clips
from emulator.skeleton import Skeleton

RATE_HZ = 60.0
BLUR_S = 2 / 60
"""Standard deviation of the Gaussian that takes tracking noise out of a foot's path before its speed is taken."""
SLOW_M_PER_S, HELD_M_PER_S = 0.25, 0.5
LOW_M, HELD_LOW_M = 0.05, 0.08
"""A foot is put down where a joint of it is slow and low, and stays down while it is no faster and higher than held."""
SHORTEST_S = 0.1
LOWEST_SHARE = 0.02
"""The height a foot's joint stands at is this quantile of its heights in the movement."""
PARTS = ("ankle", "foot", "toe")
SIDES = ("left", "right")


@dataclass(frozen=True, eq=False)
class Footing:
    """What n movements do on their feet, (n,) each; NaN where a movement never plants a foot or there are no feet.

    planted   : share of the time with a foot down
    wander_cm : how far the middle of a planted foot strays from its median place in the stance, 90 % quantile
    slide_cm  : way of a planted joint of the foot over the floor in a stance, the mean over stances
    sunk_mm   : how deep any joint goes below where it stands in recordings (see ``standing_m``), at the deepest
    """

    planted: np.ndarray
    wander_cm: np.ndarray
    slide_cm: np.ndarray
    sunk_mm: np.ndarray


def feet(skeleton: Skeleton) -> list[list[int]]:
    """Joint numbers of each foot that the skeleton has: of two, of one, or none at all."""
    found = [[skeleton.names.index(f"{side}_{p}") for p in PARTS if f"{side}_{p}" in skeleton.names] for side in SIDES]
    return [joints for joints in found if joints]


def footing(clips: Clips, standing: np.ndarray | None = None) -> Footing:
    """Look at each clip. standing : (J,) of ``standing_m`` of the recordings; None: of these clips."""
    if not feet(clips.skeleton):
        nothing = np.full(len(clips), np.nan)
        return Footing(nothing, nothing, nothing, nothing)
    standing = standing_m(clips) if standing is None else standing
    places, step_s = clips.at_rate(RATE_HZ)
    rows = [_one(clips.skeleton, p, s) for p, s in zip(places, step_s)]
    sunk = [1000 * max(float((standing - p[..., 2]).max()), 0.0) for p in places]
    planted, wander, slide = np.array(rows).T
    return Footing(planted, wander, slide, np.array(sunk))


def planted_joints(positions_m: np.ndarray, step_s: float, joints: list[int]) -> np.ndarray:
    """(T, F) whether each of these joints is planted, from positions (T, J, 3) at even steps."""
    return np.stack([_down(positions_m[:, joint], step_s) for joint in joints], axis=1)


def standing_m(clips: Clips) -> np.ndarray:
    """(J,) height below which a joint sinks: a foot's joints where they stand (the median over clips of their lowest
    height), all others where the lowest of these does: hands and knees may lie on the floor.
    """
    lowest = np.median([np.quantile(p[..., 2], LOWEST_SHARE, axis=0) for p in clips.positions_m], axis=0)
    joints = [joint for foot in feet(clips.skeleton) for joint in foot]
    floor = np.full(clips.skeleton.n_joints, lowest[joints].min() if joints else lowest.min())
    floor[joints] = lowest[joints]
    return floor


def runs(mask: np.ndarray) -> list[tuple[int, int]]:
    """(first, one past the last) of each stretch of True in (T,)."""
    edge = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return list(zip(edge[::2].tolist(), edge[1::2].tolist()))


def _one(skeleton: Skeleton, positions_m: np.ndarray, step_s: float) -> tuple[float, float, float]:
    """Share planted, wander and slide of one movement."""
    apart, ways, any_foot = [], [], np.zeros(len(positions_m), bool)
    for joints in feet(skeleton):
        down = planted_joints(positions_m, step_s, joints)
        foot: np.ndarray = np.any(down, axis=1)
        middle = positions_m[:, joints, :2].mean(axis=1)
        for first, end in runs(foot):
            place = middle[first:end]
            apart.append(np.linalg.norm(place - np.median(place, axis=0), axis=1))
        blurred = _blurred(positions_m[:, joints, :2], step_s)
        for joint in range(len(joints)):
            for first, end in runs(down[:, joint]):
                ways.append(float(np.linalg.norm(np.diff(blurred[first:end, joint], axis=0), axis=1).sum()))
        any_foot |= foot
    if not ways:
        return 0.0, float("nan"), float("nan")
    return float(any_foot.mean()), 100 * float(np.quantile(np.concatenate(apart), 0.9)), 100 * float(np.mean(ways))


def _down(place: np.ndarray, step_s: float) -> np.ndarray:
    """(T,) whether a joint (T, 3) is planted: slow and low somewhere in the stretch, held slow and low all along."""
    blurred = _blurred(place, step_s)
    speed = np.linalg.norm(np.gradient(blurred, step_s, axis=0), axis=1)
    height = blurred[:, 2] - np.quantile(blurred[:, 2], LOWEST_SHARE)
    put_down = (speed < SLOW_M_PER_S) & (height < LOW_M)
    held = put_down | ((speed < HELD_M_PER_S) & (height < HELD_LOW_M))
    down = np.zeros(len(place), bool)
    for first, end in runs(held):
        long_enough = (end - first) * step_s >= SHORTEST_S - 1e-9 or end - first == len(place)
        down[first:end] = long_enough and bool(put_down[first:end].any())
    return down


def _blurred(place: np.ndarray, step_s: float) -> np.ndarray:
    return np.asarray(gaussian_filter1d(place, BLUR_S / step_s, axis=0, mode="nearest"))


SOLE_M = 0.05
"""A sole reaches so far beyond the centres of the joints of its foot: heel, edges and toes."""


def unsupported(clips: Clips) -> np.ndarray:
    """(n,) share of the time with a foot down in which the centre of mass is outside the planted feet's polygon.

    Outside: more than ``SOLE_M`` from the polygon of the joints that are planted. NaN for a clip that never plants a
    foot. Raises ValueError for a skeleton whose centre of mass cannot be told.
    """
    joints = [joint for foot in feet(clips.skeleton) for joint in foot]
    places, step_s = clips.at_rate(RATE_HZ)
    shares = []
    for positions, step in zip(places, step_s):
        centre = centre_of_mass_m(clips.skeleton, positions)[:, :2]
        planted = planted_joints(positions, step, joints)
        down = np.any(planted, axis=1)
        away_m = distance_to_polygon(centre[down], positions[down][:, joints, :2], planted[down])
        shares.append(float(np.mean(away_m > SOLE_M)) if down.any() else np.nan)
    return np.array(shares)


def distance_to_polygon(point: np.ndarray, corners: np.ndarray, there: np.ndarray) -> np.ndarray:
    """(T,) distance of points (T, 2) to the convex hull of those corners (T, F, 2) that are ``there`` (T, F); 0 inside.

    Inside: no half turn about the point without a corner. Outside, the nearest place of the hull lies on one of its
    edges, and every other line between corners is farther. At least one corner of each is there.
    """
    way = corners - point[:, None]
    angle = np.sort(np.where(there, np.arctan2(way[..., 1], way[..., 0]), np.inf), axis=1)
    following = np.concatenate([angle[:, 1:], np.full((len(angle), 1), np.inf)], axis=1)
    last = ~np.isfinite(following)
    gap = np.where(last, angle[:, :1] + 2 * np.pi, following) - angle
    widest = np.where(np.isfinite(angle), gap, 0.0).max(axis=1)
    to_corner = np.where(there, np.linalg.norm(way, axis=-1), np.inf)
    nearest = to_corner.min(axis=1)
    for i, j in combinations(range(corners.shape[1]), 2):
        edge = corners[:, j] - corners[:, i]
        square = np.maximum(np.sum(edge**2, axis=-1), 1e-18)
        along = np.clip(-np.sum(way[:, i] * edge, axis=-1) / square, 0.0, 1.0)
        away = np.linalg.norm(way[:, i] + along[:, None] * edge, axis=-1)
        nearest = np.minimum(nearest, np.where(there[:, i] & there[:, j], away, np.inf))
    return np.where(widest < np.pi, 0.0, nearest)
