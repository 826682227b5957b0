"""Joint angles that positions alone can tell, and how far a healthy adult's joints go.

Could a body do this? Joint limits, speeds and sliding feet, of drawn performances beside recorded ones.

Read as a comparison: markers stand on the skin and people differ, so recorded frames lie outside the limits, too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from emulator.motion import MotionSet
from emulator.skeleton import Skeleton

LIMITS_DEG: dict[str, tuple[float, float]] = {
    "elbow flexion": (0.0, 150.0),
    "knee flexion": (-10.0, 135.0),
    "hip flexion": (-30.0, 120.0),
    "hip abduction": (-30.0, 45.0),
    "shoulder extension": (-90.0, 60.0),
    "trunk flexion": (-25.0, 80.0),
    "trunk side bend": (-35.0, 35.0),
    "neck flexion": (-45.0, 45.0),
    "neck side bend": (-45.0, 45.0),
}
"""Least and greatest angle. Source: American Academy of Orthopaedic Surgeons (1965), Joint Motion: Method of Measuring
and Recording; trunk as its thoracic and lumbar spine. Averages of healthy adults: some people go further."""

_Places = dict[str, np.ndarray]
_NEEDED = (
    *("pelvis", "spine", "chest", "neck", "head"),
    *(f"{side}_{j}" for side in ("left", "right") for j in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")),
)


def joint_angles_deg(skeleton: Skeleton, positions: np.ndarray) -> dict[str, np.ndarray]:
    """Angles in degrees under the names of ``LIMITS_DEG``, (..., 2) for left and right or (..., 1) for the middle.

    positions : (..., J, 3), z up or not, any unit: only directions between joints enter
    An angle whose plane says nothing (a thigh straight to the side has no hip flexion) is NaN.
    Raises ValueError where the skeleton lacks one of the canonical joints needed.
    """
    at = {name: positions[..., skeleton.index(name), :] for name in _NEEDED}
    lower = _frame(at["left_hip"] - at["right_hip"], at["spine"] - at["pelvis"])
    upper = _frame(at["left_shoulder"] - at["right_shoulder"], at["neck"] - at["chest"])
    above, head = _unit(at["neck"] - at["chest"]), _unit(at["head"] - at["neck"])
    sides = {
        "elbow flexion": _elbow,
        "knee flexion": _knee,
        "hip flexion": _hip_flexion,
        "hip abduction": _hip_abduction,
        "shoulder extension": _shoulder_extension,
    }
    found = {
        name: np.stack([angle(at, side, lower, upper) for side in ("left", "right")], -1)
        for name, angle in sides.items()
    }
    for name, bone, frame in (("trunk", above, lower), ("neck", head, upper)):
        found[f"{name} flexion"] = _in_plane(bone, frame, 1.0)[..., None]
        found[f"{name} side bend"] = _arcsine(_dot(bone, frame[0]))[..., None]
    return found


def _elbow(at: _Places, side: str, _lower: tuple, _upper: tuple) -> np.ndarray:
    return _bend(*_limb(at, side, "shoulder", "elbow", "wrist"))


def _knee(at: _Places, side: str, lower: tuple, _upper: tuple) -> np.ndarray:
    """Below 0 where the shank leaves the thigh forwards."""
    thigh, shank = _limb(at, side, "hip", "knee", "ankle")
    turn = _dot(np.cross(thigh, shank), lower[0])
    return np.where(turn < 0, _arcsine(turn), _bend(thigh, shank))


def _hip_flexion(at: _Places, side: str, lower: tuple, _upper: tuple) -> np.ndarray:
    return _in_plane(_limb(at, side, "hip", "knee", "ankle")[0], lower, -1.0)


def _hip_abduction(at: _Places, side: str, lower: tuple, _upper: tuple) -> np.ndarray:
    outward = _dot(_limb(at, side, "hip", "knee", "ankle")[0], lower[0])
    return _arcsine(outward if side == "left" else -outward)


def _shoulder_extension(at: _Places, side: str, _lower: tuple, upper: tuple) -> np.ndarray:
    """How far the upper arm is behind the trunk; no limit where it is raised above the shoulder."""
    arm = _limb(at, side, "shoulder", "elbow", "wrist")[0]
    return np.where(_dot(arm, upper[1]) < 0, _arcsine(-_dot(arm, upper[2])), np.nan)


def _limb(at: _Places, side: str, *joints: str) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors of a limb's two bones."""
    top, middle, end = (at[f"{side}_{joint}"] for joint in joints)
    return _unit(middle - top), _unit(end - middle)


def _frame(left: np.ndarray, up: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors left, up (square to left) and forward."""
    left = _unit(left)
    up = _unit(up - _dot(up, left)[..., None] * left)
    return left, up, np.cross(left, up)


def _in_plane(bone: np.ndarray, frame: tuple, up_sign: float) -> np.ndarray:
    """Angle forward of up (or, with -1, of down) in the plane of up and forward; NaN for a bone nearly square to it."""
    forward, upward = _dot(bone, frame[2]), up_sign * _dot(bone, frame[1])
    return np.where(np.hypot(forward, upward) > 0.3, np.degrees(np.arctan2(forward, upward)), np.nan)


def _bend(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), _dot(one, other)))


def _arcsine(sine: np.ndarray) -> np.ndarray:
    return np.degrees(np.arcsin(np.clip(sine, -1, 1)))


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...c,...c->...", a, b)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


FROM_STANDING = ("hip flexion", "trunk flexion", "neck flexion")
UPRIGHT = 0.98
"""Upright is within this share of the way from the head's lowest to its highest place."""
LOW_M = 0.03
"""A foot's joint is low while it is no more than this above its lowest place in the performance."""


@dataclass(frozen=True)
class Plausibility:
    """What was found of n performances.

    outside       : share of frames outside each joint limit of ``LIMITS_DEG``, left and right counted singly
    frames_outside: share of frames outside any of them
    beyond_deg    : how far the farthest frame lies outside, 0 where none does
    speed_m_per_s : the greatest speed of any joint in each performance (n,)
    skate_cm      : way of a foot over the floor while it is low in each performance (n,), the mean over ankles and toes
    """

    outside: dict[str, float]
    frames_outside: float
    beyond_deg: dict[str, float]
    speed_m_per_s: np.ndarray
    skate_cm: np.ndarray


def plausibility(
    skeleton: Skeleton,
    positions_m: Sequence[np.ndarray],
    duration_s: np.ndarray,
    standing_deg: Mapping[str, float] | None = None,
) -> Plausibility:
    """Judge performances (T, J, 3), z up, each at even times from 0 to its duration (n,).

    standing_deg : angles of upright standing, from which the limits count (see ``standing_deg``); None for zeros
    Take the same T for what is to be compared: speeds and ways are those between frames.
    Raises ValueError for a skeleton without the canonical joints needed, and for unequal numbers of performances.
    """
    if len(positions_m) != len(duration_s) or not len(duration_s):
        raise ValueError(f"plausibility: {len(positions_m)} performances and {len(duration_s)} durations")
    angles = [joint_angles_deg(skeleton, positions) for positions in positions_m]
    zero = standing_deg or {}
    together = {n: np.concatenate([one[n].ravel() for one in angles]) - zero.get(n, 0.0) for n in LIMITS_DEG}
    excess = {name: _excess(together[name], *limits) for name, limits in LIMITS_DEG.items()}
    return Plausibility(
        {name: float(np.mean(e > 0)) for name, e in excess.items()},
        _frames_outside(angles, zero),
        {name: float(e.max()) for name, e in excess.items()},
        np.array([_top_speed(p, s) for p, s in zip(positions_m, duration_s)]),
        np.array([_skate_cm(skeleton, p) for p in positions_m]),
    )


def standing_deg(skeleton: Skeleton, positions_m: Sequence[np.ndarray]) -> dict[str, float]:
    """Angles of trunk, hips and neck in the frames (T, J, 3) of each performance in which the head is highest.

    The source measures from upright standing. In recordings the joints of the trunk lie in front of the spine or behind
    it, as markers and software have it, which shifts these angles by up to some 30 degrees. The recordings must contain
    standing, or the limits are too strict or too lenient by what is missing.
    """
    found: dict[str, list[np.ndarray]] = {name: [] for name in FROM_STANDING}
    for positions in positions_m:
        height = positions[:, skeleton.index("head"), 2]
        angles = joint_angles_deg(skeleton, positions[height >= height.min() + UPRIGHT * np.ptp(height)])
        for name in FROM_STANDING:
            found[name].append(angles[name].ravel())
    return {name: float(np.nanmedian(np.concatenate(values))) for name, values in found.items()}


def recorded_positions_m(motions: MotionSet, n_times: int = 101) -> np.ndarray:
    """Recorded positions (N, T, J, 3), rigid bones, at even times of each repetition, to set beside drawn ones."""
    return np.stack([_even(motion.positions_m(), motion.time_s, n_times) for motion in motions.motions])


def plausibility_rows(emulated: Plausibility, recorded: Plausibility) -> list[tuple[str, str, float, float]]:
    """(what, unit, emulated, recorded), one row a limit and then speeds and skate."""
    both = (emulated, recorded)
    told: list[tuple[str, str, list[float]]] = [
        *((f"{name} outside", "%", [100 * p.outside[name] for p in both]) for name in LIMITS_DEG),
        ("top speed, median", "m/s", [float(np.median(p.speed_m_per_s)) for p in both]),
        ("top speed, greatest", "m/s", [float(p.speed_m_per_s.max()) for p in both]),
        ("foot skate a performance", "cm", [float(p.skate_cm.mean()) for p in both]),
    ]
    return [(what, unit, ours, theirs) for what, unit, (ours, theirs) in told]


def _excess(angles: np.ndarray, low: float, high: float) -> np.ndarray:
    """Degrees outside the limits, 0 inside and where there is no angle."""
    return np.nan_to_num(np.maximum(np.maximum(low - angles, angles - high), 0.0), nan=0.0)


def _frames_outside(angles: Sequence[Mapping[str, np.ndarray]], zero: Mapping[str, float]) -> float:
    """Share of the frames of all performances in which any angle (T, 1 or 2) is outside its limits."""
    outside = [
        np.any([(_excess(one[n] - zero.get(n, 0.0), *LIMITS_DEG[n]) > 0).any(axis=-1) for n in LIMITS_DEG], axis=0)
        for one in angles
    ]
    return float(np.mean(np.concatenate(outside)))


def _top_speed(positions_m: np.ndarray, duration_s: float) -> float:
    steps = np.linalg.norm(np.diff(positions_m, axis=0), axis=-1)
    return float(steps.max() * (len(positions_m) - 1) / duration_s)


def _skate_cm(skeleton: Skeleton, positions_m: np.ndarray) -> float:
    feet = [skeleton.index(f"{side}_{joint}") for side in ("left", "right") for joint in ("ankle", "toe")]
    place = positions_m[:, feet]
    low = place[..., 2] <= place[..., 2].min(axis=0) + LOW_M
    steps = np.linalg.norm(np.diff(place[..., :2], axis=0), axis=-1)
    return float(100 * (steps * (low[1:] & low[:-1])).sum(axis=0).mean())


def _even(positions_m: np.ndarray, time_s: np.ndarray, n_times: int) -> np.ndarray:
    at = np.linspace(0.0, time_s[-1], n_times)
    flat = positions_m.reshape(len(positions_m), -1)
    return np.stack([np.interp(at, time_s, column) for column in flat.T], -1).reshape(n_times, *positions_m.shape[1:])
