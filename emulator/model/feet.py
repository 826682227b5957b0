"""Feet on the floor: when each foot stood in a recording, where it slipped meanwhile, and bodies that stand like that.

A foot that is locked to a point is as easily told from a recorded one as a foot that slides: recorded feet slip by
1-6 cm while they stand. So a drawn performance takes the stances of the recording that it is nearest to, with their
slip: each stance stays about the place where the draw has it, the root moves by the feet's mean correction and to
where the feet carry it, and the legs bend by what is left (two-bone inverse kinematics, lengths kept).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from emulator.geometry.centre_of_mass import NEEDED, joint_masses
from emulator.motion import Motion, stretches, turn
from emulator.skeleton import Skeleton

SIDES = ("left", "right")
SLOW_M_PER_S, HELD_M_PER_S = 0.25, 0.5
LOW_M, HELD_LOW_M = 0.05, 0.08
"""A foot comes to stand where its ankle or toe is slow and low, and stands until it is no longer slow or low enough."""
SHORTEST_S = 0.1
FLOOR_SHARE = 0.02
NO_FLOOR = -1e9
PRINT, FIRST_PRINT = 4e-6, 1e-4
"""What prints are rounded to, in leg lengths, now and in the first libraries that had them: steps of a fiftieth of a
millimetre are seen where feet do not move at all."""
TURN_RAD = 4e-5
"""What the directions of feet are rounded to: two hundredths of a millimetre at the end of a foot."""
PRINTS = np.array([PRINT, PRINT, PRINT, TURN_RAD, TURN_RAD])
STRAY = 1e-4
"""What distances of the centre of mass are rounded to, in leg lengths."""
BREATHES = 1e-3
"""Bones whose length changes less than this share of it are taken as rigid."""


@dataclass(frozen=True)
class Legs:
    """What of a skeleton stands and bends: feet (2, 2) ankle and toe joints, bones (2, 2) to knee and ankle, by side.

    bones is None where a knee or a hip lies between that is not theirs: then only the root is moved.
    joints : (2, K) those of the feet from ankle to toe, the ankle repeated where one side has fewer
    soles : (2, K) bones from ankle to toe, -1 where one side has fewer; none where a toe does not hang from its ankle
    mass : (J,) shares of the joints in the centre of mass; None where the skeleton does not tell it
    """

    feet: np.ndarray
    bones: np.ndarray | None
    soles: np.ndarray
    joints: np.ndarray
    mass: np.ndarray | None = None

    @classmethod
    def of(cls, skeleton: Skeleton) -> Legs | None:
        """None for a skeleton that lacks an ankle or a toe."""
        names = skeleton.names
        wanted = [f"{side}_{joint}" for side in SIDES for joint in ("ankle", "toe")]
        if not set(wanted) <= set(names):
            return None
        feet = np.array([names.index(name) for name in wanted], dtype=np.int64).reshape(2, 2)
        limbs = [[f"{side}_{joint}" for joint in ("hip", "knee", "ankle")] for side in SIDES]
        whole = all(
            set(limb) <= set(names)
            and all(skeleton.parents[names.index(b)] == names.index(a) for a, b in pairwise(limb))
            for limb in limbs
        )
        bones = [[skeleton.bone_names.index(joint) for joint in limb[1:]] for limb in limbs] if whole else None
        ways = [_bones_between(skeleton, ankle, toe) for ankle, toe in feet]
        longest = max(map(len, ways)) if all(ways) else 0
        soles = np.array([(way + [-1] * longest)[:longest] for way in ways], dtype=np.int64)
        between = [[names.index(skeleton.bone_names[bone]) for bone in sole[:-1] if bone >= 0] for sole in ways]
        most = max(map(len, between)) if longest else 0
        joints = np.array([[a] * (1 + most - len(own[:most])) + own[:most] + [t] for (a, t), own in zip(feet, between)])
        mass = joint_masses(skeleton) if set(NEEDED) <= set(names) else None
        return cls(feet, None if bones is None else np.array(bones, dtype=np.int64), soles, joints, mass)


def _bones_between(skeleton: Skeleton, upper: int, lower: int) -> list[int]:
    """Bones from one joint down to another; none if that does not hang from it."""
    bones: list[int] = []
    while lower not in (upper, -1):
        name, lower = skeleton.names[lower], skeleton.parents[lower]
        bones = [skeleton.bone_names.index(name), *bones] if lower >= 0 else []
    return bones if lower == upper else []


def standing(positions_m: np.ndarray, rate_hz: float, legs: Legs) -> np.ndarray:
    """(2, T) whether the left and the right foot stand in joints (T, J, 3), z up, at ``rate_hz`` frames a second.

    A foot stands where its ankle or its toe does, for 0.1 s or longer; low is counted from where that joint is lowest
    (the 2 % quantile), so that a shoe's height and the place of a marker do not matter.
    """
    from scipy.ndimage import gaussian_filter1d

    out = np.zeros((2, len(positions_m)), bool)
    if len(positions_m) < 3:
        return out
    for side, foot in enumerate(legs.feet):
        for joint in foot:
            way = gaussian_filter1d(positions_m[:, joint], rate_hz / 30.0, axis=0, mode="nearest")
            speed = np.linalg.norm(np.gradient(way, 1.0 / rate_hz, axis=0), axis=1)
            height = way[:, 2] - np.quantile(way[:, 2], FLOOR_SHARE)
            held = (speed < HELD_M_PER_S) & (height < HELD_LOW_M)
            lands = (speed < SLOW_M_PER_S) & (height < LOW_M)
            for start, stop in stretches(held):
                if lands[start:stop].any():
                    out[side, start:stop] = True
        for start, stop in stretches(out[side]):
            if stop - start < SHORTEST_S * rate_hz:
                out[side, start:stop] = False
    return out


def prints(positions_m: np.ndarray, yaw_rad: np.ndarray, stands: np.ndarray, legs: Legs) -> np.ndarray:
    """(2, T, 5) where each foot (the middle of ankle and toe) is while it stands, metres, and how it points, else 0.

    Level about the median place of the stance, in the frame of the heading yaw_rad (T,); its height above the floor.
    Then the way in which it points to its toe, about that of its mean in the stance, and how far up, in radians.
    """
    out = np.zeros((2, len(positions_m), 5))
    for side, foot in enumerate(legs.feet):
        middle, toward = positions_m[:, foot].mean(axis=1), positions_m[:, foot[1]] - positions_m[:, foot[0]]
        toward = toward / np.maximum(np.linalg.norm(toward, axis=1, keepdims=True), 1e-12)
        for start, stop in stretches(stands[side]):
            rows = slice(start, stop)
            slip = middle[rows] - np.append(np.median(middle[rows, :2], axis=0), 0.0)
            out[side, rows, :3] = turn(slip, -yaw_rad[rows])
            along, across = toward[rows, :2].sum(axis=0)
            x, y, up = turn(toward[rows], -np.arctan2(across, along)).T
            out[side, rows, 3], out[side, rows, 4] = np.arctan2(y, x), np.arcsin(np.clip(up, -1.0, 1.0))
    return out


def pointed(prints: np.ndarray) -> np.ndarray:
    """(..., 3 or 6) prints (..., 3 or 5) with the unit vector to the toe in place of its two angles."""
    way, pitch = prints[..., 3:4], prints[..., 4:5]
    return np.concatenate(
        [prints[..., :3], np.cos(pitch) * np.cos(way), np.cos(pitch) * np.sin(way), np.sin(pitch)], axis=-1
    )


def on_its_feet(motion: Motion) -> Motion:
    """The motion with bones of one length, its feet where they were recorded.

    Markers on the skin make bones that breathe: rigid bones hung from the recorded pelvis would lift the feet of a
    squat by 5 to 9 cm. The root moves and the legs bend until the feet stand where they stood. The very same motion
    where bones do not breathe, or the skeleton has no feet.
    """
    legs = Legs.of(motion.skeleton)
    if legs is None or motion.stretch is None or np.abs(motion.stretch - 1.0).max() < BREATHES:
        return motion
    recorded = motion.positions_m(rigid=False)
    rate_hz = (len(motion.time_s) - 1) / motion.duration_s
    stands = standing(recorded, rate_hz, legs)
    if not stands.any():
        return motion
    own = prints(recorded, motion.yaw_rad, stands, legs)
    path = np.concatenate([motion.root_m, motion.yaw_rad[:, None]], axis=1)
    stance = Stance.on(stands[None], own[None], min(0.0, float(recorded[..., 2].min())))
    one = motion.directions[None], motion.bone_length_m[None], path[None], motion.time_s[None]
    footed_path, bends, _ = stood(motion.skeleton, legs, *one, stance)
    directions = motion.directions[None].copy()
    bend(directions, motion.bone_length_m[None], legs, np.arange(float(len(path)))[None], bends)
    root = footed_path[0, :, :3]
    return replace(motion, directions=directions[0], root_m=root - np.append(root[0, :2], 0.0), stretch=None)


def fastest_m_per_s(motions: Sequence[Motion]) -> np.ndarray:
    """(N,) the greatest speed of any joint in each motion, between frames of 1/30 s."""
    return np.array([fastest_of(motion.positions_m(), np.array(motion.time_s, float)) for motion in motions])


def fastest_of(positions_m: np.ndarray, time_s: np.ndarray) -> float:
    """The greatest speed of joints (T, J, 3) that come at times (T,), m/s, between frames of 1/30 s."""
    from emulator.kernels.feet import fastest_joint

    return float(fastest_joint(positions_m, np.zeros((3, len(time_s))), time_s))


def strays(positions_m: np.ndarray, stands: np.ndarray, legs: Legs, step_s: float) -> np.ndarray:
    """(T,) how far the centre of mass is, seen from above, from between the feet that carry it, in metres.

    positions_m (T, J, 3) every ``step_s`` seconds, stands (2, T). inf where nothing tells the centre of mass.
    """
    from emulator.kernels.balance import strayed
    from emulator.kernels.feet import carrying

    out = np.full(len(positions_m), np.inf)
    if legs.mass is not None and stands.any():
        weight = np.empty(stands.shape)
        carrying(stands, step_s, np.empty(len(out)), weight)
        places = positions_m[:, legs.feet, :2].mean(axis=2).transpose(1, 2, 0)
        centres = (legs.mass @ positions_m)[:, :2]
        strayed(np.ascontiguousarray(centres), np.ascontiguousarray(places), weight, out)
    return out


@dataclass(frozen=True, eq=False)
class Stance:
    """How n bodies stand, on the common clock of T points, in metres.

    stands : (n, 2, T) whether each foot does; prints_m : (n, 2, T, 3 or 6) see ``pointed``
    floor_m : (n,) no joint gets below this height; foot_floor_m : (n, 2, 2 or K) nor ankle, toe and what lies between
        them below these, by side
    stray_m : (n, T) how far the centre of mass may be off the feet; inf as it is
    """

    stands: np.ndarray
    prints_m: np.ndarray
    floor_m: np.ndarray
    foot_floor_m: np.ndarray
    stray_m: np.ndarray

    @classmethod
    def on(cls, stands: np.ndarray, prints_m: np.ndarray, floor_m: float) -> Stance:
        """Of n bodies above one floor that lean as they do and whose feet have no floor of their own."""
        n, n_times = len(stands), stands.shape[-1]
        return cls(
            stands, pointed(prints_m), np.full(n, floor_m), np.full((n, 2, 2), NO_FLOOR), np.full((n, n_times), np.inf)
        )


def stood(
    skeleton: Skeleton,
    legs: Legs | None,
    directions: np.ndarray,
    length_m: np.ndarray,
    path: np.ndarray,
    time_s: np.ndarray,
    stance: Stance,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The path (n, T, 4) of roots and headings moved until the feet stand, and what the legs must bend (n, 2, T, 6).

    And the greatest speed of any joint (n,), m/s, between frames of 1/30 s.

    directions (n, T, B, 3) without heading, length_m (n, B); time_s (n, T) : when the points come
    """
    from emulator.kernels.feet import footed

    n, n_times = path.shape[:2]
    out, bends, fastest = np.array(path, dtype=float), np.zeros((n, 2, n_times, 6)), np.zeros(n)
    feet = np.zeros((2, 2), np.int64) if legs is None else legs.joints
    bones = np.zeros((2, 0), np.int64) if legs is None or legs.bones is None else legs.bones
    mass = np.zeros(0) if legs is None or legs.mass is None else legs.mass
    flat = np.ascontiguousarray(directions, dtype=float).reshape(n, n_times, -1)
    foot_floor_m = np.full((n, *feet.shape), NO_FLOOR)
    if stance.foot_floor_m.shape == foot_floor_m.shape:
        foot_floor_m = stance.foot_floor_m
    else:  # nothing is known of what lies between ankle and toe
        foot_floor_m[..., [0, -1]] = stance.foot_floor_m[..., [0, -1]]
    given = time_s, stance.floor_m, foot_floor_m, mass, stance.stray_m
    length_m, *numbers = (np.ascontiguousarray(values, dtype=float) for values in (length_m, *given))
    own = stance.stands, stance.prints_m
    footed(flat, length_m, skeleton.chain, feet, bones, *own, *numbers, out, bends, fastest)
    return out, bends, fastest


def bend(directions: np.ndarray, length_m: np.ndarray, legs: Legs, place: np.ndarray, bends: np.ndarray) -> None:
    """Bend the legs of directions (n, S, B, 3) at places (n, S) of the points of bends (n, 2, T, 6), in place.

    NOTE: the bends serve as control points of their spline themselves: they are smooth, and it blunts what is not.
    """
    from emulator.kernels.legs import bent

    if legs.bones is None:
        return
    control = np.concatenate([bends[:, :, :1], bends, bends[:, :, -1:]], axis=2)
    bent(directions.reshape(*place.shape, -1), np.ascontiguousarray(length_m), legs.bones, legs.soles, place, control)


@dataclass(frozen=True, eq=False)
class Footing:
    """How the feet of N recordings stood, on the common clock of T points.

    postures : (N, P) posture coefficients of each, by which the nearest is found
    stands   : (N, 2, T) whether the left and the right foot stands
    prints   : (N, 2, T, 5) see ``prints``, in leg lengths; in libraries of before (N, 2, T, 3), without directions
    floor    : (N,) the height of the lowest joint in leg lengths, at most 0: how far a recording is below the floor
    foot_floor : (N, 2, K) the same of the joints from ankle to toe of each side, of ankle and toe alone in libraries
        of before; they may lie above 0
    strays   : (N, T) see ``strays``, in leg lengths; inf in libraries of before
    """

    postures: np.ndarray
    stands: np.ndarray
    prints: np.ndarray
    floor: np.ndarray
    foot_floor: np.ndarray
    strays: np.ndarray

    @classmethod
    def fit(
        cls, motions: Sequence[Motion], warps: np.ndarray, postures: np.ndarray, leg_m: np.ndarray
    ) -> Footing | None:
        """From motions on their feet, warps (N, T), posture coefficients (N, P), legs (N,); None without feet."""
        from scipy.interpolate import CubicSpline

        legs = Legs.of(motions[0].skeleton)
        if legs is None:
            return None
        stands, places, lowest, foot_lowest, far = [], [], [], [], []
        for motion, gamma, leg in zip(motions, warps, leg_m):
            joints, rate_hz = motion.positions_m(), (len(motion.time_s) - 1) / motion.duration_s
            own = standing(joints, rate_hz, legs)
            frames, at = np.arange(len(joints)), gamma * (len(joints) - 1)
            there = CubicSpline(frames, joints)(at)
            yaw = np.interp(at, frames, motion.yaw_rad)
            stands.append(own[:, np.rint(at).astype(int)])
            places.append(prints(there, yaw, stands[-1], legs) / [leg, leg, leg, 1.0, 1.0])
            far.append(strays(there, stands[-1], legs, motion.duration_s / (len(at) - 1)) / leg)
            lowest.append(joints[..., 2].min() / leg)
            foot_lowest.append(joints[:, legs.joints, 2].min(axis=0) / leg)
        whole, strayed = np.rint(np.array(places) / PRINTS), np.rint(np.array(far) / STRAY)
        floors = np.minimum(lowest, 0.0), np.array(foot_lowest)
        return cls(postures, np.array(stands), whole * PRINTS, *floors, strayed * STRAY)

    @cached_property
    def _pointed(self) -> np.ndarray:
        return pointed(self.prints)

    def nearest(self, postures: np.ndarray, whitening: np.ndarray | None = None) -> np.ndarray:
        """(n,) the recordings whose coefficients are nearest to postures (n, P), both times ``whitening`` (P, P)."""
        own, known = (rows if whitening is None else rows @ whitening for rows in (postures, self.postures))
        square = np.sum(known**2, axis=1) - 2 * own @ known.T
        return np.asarray(square.argmin(axis=1))

    def stance(self, near: np.ndarray, leg_m: np.ndarray) -> Stance:
        """How bodies with legs of these lengths (n,) stand that stand as the recordings ``near`` (n,)."""
        prints_m, leg_of = self._pointed[near], leg_m[:, None, None]
        prints_m[..., :3] *= leg_of[..., None]
        floors = self.floor[near] * leg_m, self.foot_floor[near] * leg_of
        stray_m = self.strays[near] * leg_m[:, None]
        return Stance(self.stands[near], prints_m, *floors, stray_m)
