"""Bones that breathe: their lengths in a take, told; or, where asked, each held at its median length.

Holding them is not what is done unless asked: where joints come from markers on the skin, bones truly change with
posture, and rigid ones hung from the pelvis move feet by centimetres. A bone that leaves its median by more than
``bad_bone_share`` for long is no bone, and the take is bad.

Joint angles from joint positions, and turning what lies beyond a joint to change one.

Angles that no joint can do: told, or, where asked, turned back to what is believed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from emulator.cleaning.report import Repair
from emulator.cleaning.settings import CleaningSettings, Limit, limits_for
from emulator.recordings.take import Take
from emulator.skeleton import Skeleton

LEAST_SD_SHARE = 0.01
"""A bone breathes if its length has this standard deviation over its median."""
LEAST_SHARE = 1e-6
BAD_FOR = 0.01
"""A bone is bad if it is off for this share of the frames."""


def with_even_bones(take: Take, settings: CleaningSettings) -> tuple[Take, tuple[Repair, ...]]:
    """The take and, for each bone that breathes, its standard deviation in % with the greatest change in words."""
    if settings.bones == "off" or take.parents is None:
        return take, ()
    skeleton = Skeleton(take.names, take.parents)
    length_m = skeleton.bone_lengths(take.positions_m)
    median_m = np.median(length_m, axis=0)
    usable = median_m > 1e-9
    share = np.where(usable, length_m / np.where(usable, median_m, 1.0) - 1.0, 0.0)
    mend = settings.bones == "mend" and bool(np.abs(share).max() > LEAST_SHARE)
    repairs = tuple(_repairs(take, skeleton, share, mend, settings))
    return _rigid(take, skeleton, median_m) if mend else take, repairs


def median_lengths_m(take: Take) -> np.ndarray:
    """(J,) median length of the bone that ends at each joint, nan at the root and where nothing is known."""
    if take.parents is None:
        return np.full(len(take.names), np.nan)
    parents = np.array(take.parents)
    bone = take.positions_m - take.positions_m[:, np.maximum(parents, 0)]
    seen = np.isfinite(bone).all(axis=(1, 2))
    length = np.median(np.linalg.norm(bone[seen], axis=-1), axis=0) if seen.any() else np.full(len(parents), np.nan)
    return np.where(parents >= 0, length, np.nan)


def _rigid(take: Take, skeleton: Skeleton, median_m: np.ndarray) -> Take:
    """Joints at the median lengths along the recorded directions, from the root outwards."""
    positions = take.positions_m.copy()
    for bone, parent, child in skeleton.chain.tolist():
        vector = take.positions_m[:, child] - take.positions_m[:, parent]
        length = np.linalg.norm(vector, axis=-1, keepdims=True)
        positions[:, child] = positions[:, parent] + vector * (median_m[bone] / np.where(length > 1e-12, length, 1.0))
    return replace(take, positions_m=positions)


def _repairs(take: Take, skeleton: Skeleton, share: np.ndarray, mend: bool, settings: CleaningSettings) -> list[Repair]:
    repairs = []
    for bone, name in enumerate(skeleton.bone_names):
        off, sd = np.abs(share[:, bone]), float(share[:, bone].std())
        bad = bool(np.mean(off > settings.bad_bone_share) > BAD_FOR)
        if sd < LEAST_SD_SHARE and not bad and not (mend and off.max() > LEAST_SHARE):
            continue
        what = "is no bone" if bad else "breathes"
        done = "held at its median length" if mend else "left as it is"
        words = f"the bone that ends there {what}: sd {sd:.1%}, at most {off.max():.0%}; {done}"
        repairs.append(Repair(take.name, "bone", (name,), 0, take.n_frames - 1, 100 * sd, "%", words, mend, bad))
    return repairs


MOST_OVER_DEG = 60.0
"""A knee that seems further over is a bent one with a foot that points the wrong way."""


def angle_deg(take: Take, limit: Limit) -> tuple[np.ndarray, np.ndarray]:
    """The angle (T,) in degrees that a limit speaks of, and the unit axis (T, 3) about which turning enlarges it.

    nan where it cannot be told: a bone without length, an axis without direction, a body without hips.
    """
    near, far = (_unit(_bone(take, *pair)) for pair in (limit.bones[:2], limit.bones[2:]))
    if limit.kind == "behind":
        return _behind(take, far)
    axis = np.cross(near, far)
    bend = np.degrees(np.arctan2(np.linalg.norm(axis, axis=-1), np.sum(near * far, axis=-1)))
    axis = _unit(axis)
    if limit.kind == "over":
        return _over(take, limit, near, bend, axis)
    return bend, axis


def neutral_deg(takes: list[Take], limit: Limit) -> float:
    """What an angle is when a person stands: its median over the first frames of the takes; 0 but for a lift."""
    if limit.kind != "lift":
        return 0.0
    return float(np.nanmedian([angle_deg(take, limit)[0][0] for take in takes]))


def turned(take: Take, joint: str, far: str, axis: np.ndarray, by_deg: np.ndarray) -> np.ndarray:
    """Positions (T, J, 3) with all that hangs on ``far`` turned about ``joint`` by by_deg (T,) about axis (T, 3)."""
    assert take.parents is not None
    centre = take.positions_m[:, [take.names.index(joint)]]
    moved = beyond(take, far)
    positions = take.positions_m.copy()
    arm = positions[:, moved] - centre
    angle = np.radians(np.where(np.isfinite(by_deg), by_deg, 0.0))[:, None, None]
    axis = np.where(np.isfinite(axis), axis, 0.0)[:, None, :]
    along = axis * np.sum(axis * arm, axis=-1, keepdims=True)
    turned_arm = along + np.cos(angle) * (arm - along) + np.sin(angle) * np.cross(axis, arm)  # Rodrigues
    positions[:, moved] = np.where(by_deg[:, None, None] != 0, centre + turned_arm, positions[:, moved])
    return positions


def beyond(take: Take, far: str) -> list[int]:
    """The joint ``far`` and all that hang on it."""
    assert take.parents is not None
    inside = {take.names.index(far)}
    while len(inside) < len(more := inside | {j for j, parent in enumerate(take.parents) if parent in inside}):
        inside = more
    return sorted(inside)


def _bone(take: Take, start: str, end: str) -> np.ndarray:
    return take.positions_m[:, take.names.index(end)] - take.positions_m[:, take.names.index(start)]


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(length > 1e-9, vectors / np.where(length > 1e-9, length, 1.0), np.nan)


def _over(
    take: Take, limit: Limit, near: np.ndarray, bend: np.ndarray, axis: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The bend, positive where it goes against the way a knee bends, which the foot shows."""
    toe = limit.far.replace("ankle", "toe")
    if toe not in take.names:
        return np.full(len(bend), np.nan), axis
    shin = _unit(_bone(take, *limit.bones[2:]))
    foot = _bone(take, limit.far, toe)
    foot = foot - shin * np.sum(foot * shin, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        # in a bent knee the thigh points to where the foot does; a knee so far over has a foot that points wrongly
        against = (np.sum(near * foot, axis=-1) < 0) & (bend < MOST_OVER_DEG)
    return np.where(against, bend, -bend), np.where(against[:, None], axis, -axis)


def _behind(take: Take, arm: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far the upper arm points behind the trunk, in degrees; the trunk looks along hips cross spine."""
    if not {"left_hip", "right_hip", "pelvis", "neck"} <= set(take.names):
        return np.full(len(arm), np.nan), np.full(arm.shape, np.nan)
    back = -_unit(np.cross(_bone(take, "right_hip", "left_hip"), _bone(take, "pelvis", "neck")))
    sine = np.clip(np.sum(arm * back, axis=-1), -1.0, 1.0)
    return np.degrees(np.arcsin(sine)), _unit(np.cross(arm, back))


LEAST_DEG = 0.01


def within_limits(
    take: Take, settings: CleaningSettings, neutral: Mapping[tuple[str, str], float]
) -> tuple[Take, tuple[Repair, ...]]:
    """The take and, for each angle beyond its limit by more than ``tolerance_deg``, how far at most, in degrees.

    neutral : what an angle is when the person stands, by (joint, movement); 0 where it is not in it
    Where asked (``angles="mend"``), what hangs on the joint is turned until the angle is believed, frame by frame:
    a clamp, so that nothing jumps; a hand or foot then leaves what it holds or stands on.
    """
    if settings.angles == "off" or take.parents is None:
        return take, ()
    repairs = []
    for limit in limits_for(take.names):
        beyond, axis = _beyond(take, limit, neutral, settings.tolerance_deg)
        frames = np.flatnonzero(np.abs(beyond) > LEAST_DEG)
        if not len(frames):
            continue
        mend = settings.angles == "mend"
        worst = float(np.abs(beyond).max()) + settings.tolerance_deg
        repairs.append(_repair(take, limit, frames, worst, mend))
        if mend:
            take = replace(take, positions_m=turned(take, limit.joint, limit.far, axis, -beyond))
    return take, tuple(repairs)


def neutral_angles(takes: list[Take]) -> dict[tuple[str, str], float]:
    """The angles of one person's standing posture, of those limits that are reckoned from it."""
    if not takes or takes[0].parents is None:
        return {}
    limits = [limit for limit in limits_for(takes[0].names) if limit.kind == "lift"]
    return {(limit.joint, limit.what): neutral_deg(takes, limit) for limit in limits}


def _beyond(
    take: Take, limit: Limit, neutral: Mapping[tuple[str, str], float], tolerance_deg: float
) -> tuple[np.ndarray, np.ndarray]:
    """How far (T,) the angle is beyond what is believed, negative below, 0 within; and its axis (T, 3)."""
    angle, axis = angle_deg(take, limit)
    angle = angle - neutral.get((limit.joint, limit.what), 0.0)
    over = np.maximum(angle - (limit.high_deg + tolerance_deg), 0.0)
    under = np.minimum(angle - (limit.low_deg - tolerance_deg), 0.0)
    return np.nan_to_num(over + under, nan=0.0), axis


def _repair(take: Take, limit: Limit, frames: np.ndarray, worst: float, mend: bool) -> Repair:
    done = "turned back to what is believed" if mend else "left as it is"
    long = f"{len(frames)} frame{'s' * (len(frames) > 1)}"
    words = f"{limit.what} {worst:.0f} deg beyond its limit in {long} ({limit.source}); {done}"
    first, last = int(frames[0]), int(frames[-1])
    return Repair(take.name, "angle", (limit.joint,), first, last, worst, "deg", words, mend)
