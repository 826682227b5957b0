"""Legs put on given ankles: two rigid bones from hip to ankle, the knee to the side where it was."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from emulator.skeleton import Skeleton

REACH = 0.996
"""The most of its length to which a leg stretches."""
SOFT_M = 0.004
"""How softly the hips come down where a leg would have to stretch."""
AHEAD = 0.3
_LEG = ("hip", "knee", "ankle", "toe")


@dataclass(frozen=True)
class Legs:
    """Joint numbers of both legs, hip to toe, and the joints that hang on an ankle or a toe, of one skeleton."""

    joints: tuple[tuple[int, ...], tuple[int, ...]]
    below: tuple[tuple[tuple[int, int], ...], tuple[tuple[int, int], ...]]
    """Of each leg (joint, parent) of what hangs on its ankle or toe besides."""

    @classmethod
    def of(cls, skeleton: Skeleton) -> Legs | None:
        """None for a skeleton without two legs whose knee hangs on the hip and whose ankle on the knee."""
        if not {f"{side}_{joint}" for side in ("left", "right") for joint in _LEG} <= set(skeleton.names):
            return None
        joints = tuple(tuple(skeleton.names.index(f"{side}_{joint}") for joint in _LEG) for side in ("left", "right"))
        for hip, knee, ankle, toe in joints:
            if skeleton.parents[knee] != hip or skeleton.parents[ankle] != knee or ankle not in _up(skeleton, toe):
                return None
        below = tuple(
            tuple((j, skeleton.parents[j]) for j in _outwards(skeleton) if leg[2] in _up(skeleton, j)) for leg in joints
        )
        return cls((joints[0], joints[1]), (below[0], below[1]))


def _up(skeleton: Skeleton, joint: int) -> list[int]:
    path, parent = [], skeleton.parents[joint]
    while parent >= 0:
        path.append(parent)
        parent = skeleton.parents[parent]
    return path


def _outwards(skeleton: Skeleton) -> list[int]:
    return sorted(range(skeleton.n_joints), key=lambda joint: len(_up(skeleton, joint)))


def wanting_m(joints_m: np.ndarray, ankles_m: np.ndarray, legs: Legs, bone_m: Mapping[int, float]) -> np.ndarray:
    """(T,) how much the hips must come down so that no leg of joints (T, J, 3) stretches to its ankle (T, 2, 3).

    Below 0 there is room to spare.
    """
    room = []
    for (hip, knee, ankle, _), target in zip(legs.joints, np.moveaxis(ankles_m, 1, 0)):
        apart = target - joints_m[:, hip]
        full = REACH * (bone_m[knee] + bone_m[ankle])
        level = np.minimum(np.linalg.norm(apart[:, :2], axis=-1), 0.98 * full)
        room.append(-(apart[:, 2] + np.sqrt(full**2 - level**2)))
    return np.asarray(np.max(room, axis=0))


def stand_on(
    joints_m: np.ndarray, ankles_m: np.ndarray, feet: np.ndarray, legs: Legs, bone_m: Mapping[int, float]
) -> np.ndarray:
    """Joints (T, J, 3) with the ankles at ankles_m (T, 2, 3), feet along unit vectors (T, 2, 3), knees on their side.

    bone_m : length of the bone that ends in a joint. An ankle out of reach is approached to ``REACH`` of the leg.
    """
    out = joints_m.copy()
    lowered = SOFT_M * np.logaddexp(0.0, wanting_m(joints_m, ankles_m, legs, bone_m) / SOFT_M)
    out[..., 2] -= lowered[:, None]
    for number, ((hip, knee, ankle, toe), hanging) in enumerate(zip(legs.joints, legs.below)):
        target = ankles_m[:, number]
        side = _bent_to(joints_m[:, hip], joints_m[:, knee], joints_m[:, ankle], feet[:, number])
        place = {knee: 0, ankle: 1}
        middle, end = _two_bones(out[:, hip], target, bone_m[knee], bone_m[ankle], side)
        before = {joint: joints_m[:, joint] - joints_m[:, parent] for joint, parent in hanging}
        out[:, [knee, ankle]] = np.stack([middle, end], axis=1)[:, [place[knee], place[ankle]]]
        turned = feet[:, number] * np.linalg.norm(before[toe], axis=-1, keepdims=True) if toe in before else None
        for joint, parent in hanging:
            out[:, joint] = out[:, parent] + (turned if joint == toe and parent == ankle else before[joint])
    return out


def _bent_to(hip: np.ndarray, knee: np.ndarray, ankle: np.ndarray, foot: np.ndarray) -> np.ndarray:
    """(T, 3) the side to which a knee is bent: off the line from hip to ankle, and a little where the foot points.

    The latter decides where the leg is nearly straight, so that a knee never turns round.
    """
    along = _unit(ankle - hip)
    off = knee - hip
    off = off - np.sum(off * along, axis=-1, keepdims=True) * along
    level = foot * np.array([1.0, 1.0, 0.0])
    return off / np.linalg.norm(knee - hip, axis=-1, keepdims=True) + AHEAD * _unit(level)


def _two_bones(
    start: np.ndarray, target: np.ndarray, upper: float, lower: float, side: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Middle and end (T, 3) of a limb; its middle lies on the ``side`` (T, 3) of the line where it was."""
    apart = target - start
    distance = np.linalg.norm(apart, axis=-1, keepdims=True)
    along = apart / np.maximum(distance, 1e-9)
    reach = np.clip(distance, abs(upper - lower) + 0.02, REACH * (upper + lower))
    fore = (upper**2 - lower**2 + reach**2) / (2 * reach)
    out = side - np.sum(side * along, axis=-1, keepdims=True) * along
    out = out / np.maximum(np.linalg.norm(out, axis=-1, keepdims=True), 1e-9)
    height = np.sqrt(np.maximum(upper**2 - fore**2, 0.0))
    middle = start + fore * along + height * out
    end = start + reach * along
    # exactly as long as they are, whatever rounding did
    middle = start + upper * _unit(middle - start)
    return middle, middle + lower * _unit(end - middle)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
