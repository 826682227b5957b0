"""Where the centre of mass is over the feet that carry it: a body's segments, and the polygon of the planted joints."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from emulator.judge.clips import Clips
from emulator.judge.footing import RATE_HZ, feet, planted_joints
from emulator.skeleton import Skeleton

SOLE_M = 0.05
"""A sole reaches so far beyond the centres of the joints of its foot: heel, edges and toes."""
HEAD, TRUNK, TRUNK_CENTRE = 0.0681, 0.43015, 0.4949
LIMBS = (
    ("shoulder", "elbow", 0.0263, 0.5763),
    ("elbow", "wrist", 0.0150, 0.4567),
    ("wrist", "hand", 0.00585, 0.7687),
    ("hip", "knee", 0.1447, 0.3854),
    ("knee", "ankle", 0.0457, 0.4374),
    ("ankle", "toe", 0.0133, 0.5),
)
"""Joints of a limb's segment, its share of body mass, its centre as a share of the way: the means of men and women of
de Leva 1996, J. Biomech. 29, 1223-1230, table 4; trunk from hips to neck; the head's centre at its joint, the foot's
half-way between ankle and toe, which the table does not have. ``opsim`` has the table by sex, for loads on joints."""
NEEDED = (
    *("neck", "head"),
    *(f"{side}_{j}" for side in ("left", "right") for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")),
)


def centre_of_mass_m(skeleton: Skeleton, positions_m: np.ndarray) -> np.ndarray:
    """(..., 3) from joints (..., J, 3). A hand or a toe that the skeleton lacks weighs at the wrist or the ankle.

    Raises ValueError for a skeleton without one of ``NEEDED``.
    """
    absent = [name for name in NEEDED if name not in skeleton.names]
    if absent:
        raise ValueError(f"centre of mass: the skeleton has no {', '.join(absent)}")

    def at(name: str) -> np.ndarray:
        return positions_m[..., skeleton.names.index(name), :]

    hips = 0.5 * (at("left_hip") + at("right_hip"))
    moment, mass = HEAD * at("head") + TRUNK * (hips + TRUNK_CENTRE * (at("neck") - hips)), HEAD + TRUNK
    for side in ("left", "right"):
        for near, far, share, centre in LIMBS:
            start = at(f"{side}_{near}")
            end = at(f"{side}_{far}") if f"{side}_{far}" in skeleton.names else start
            moment, mass = moment + share * (start + centre * (end - start)), mass + share
    return np.asarray(moment / mass)


def unsupported(clips: Clips) -> np.ndarray:
    """(n,) share of the time with a foot down in which the centre of mass is outside the planted feet's polygon.

    Outside: more than ``SOLE_M`` from the polygon of the joints that are planted. NaN for a clip that never plants a
    foot. Raises ValueError for a skeleton without the joints of ``NEEDED``.
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
