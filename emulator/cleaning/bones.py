"""Bones that breathe: their lengths in a take, told; or, where asked, each held at its median length.

Holding them is not what is done unless asked: where joints come from markers on the skin, bones truly change with
posture, and rigid ones hung from the pelvis move feet by centimetres. A bone that leaves its median by more than
``bad_bone_share`` for long is no bone, and the take is bad.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from emulator.cleaning.found import Repair
from emulator.cleaning.settings import CleaningSettings
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
