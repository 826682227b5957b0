"""Legs put on given ankles: two rigid bones from hip to ankle, the knee to the side where it was."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from emulator.skeleton import Skeleton

_LEG = ("hip", "knee", "ankle", "toe")


@dataclass(frozen=True)
class Legs:
    """Joint numbers of both legs, hip to toe, and the joints that hang on an ankle or a toe, of one skeleton."""

    joints: tuple[tuple[int, ...], tuple[int, ...]]
    below: tuple[tuple[tuple[int, int], ...], tuple[tuple[int, int], ...]]
    """Of each leg (joint, parent) of what hangs on its ankle or toe besides."""

    @cached_property
    def tables(self) -> tuple[np.ndarray, np.ndarray]:
        """``joints`` (2, 4) and ``below`` (2, K, 2) as the kernels take them, filled up with -1."""
        below = np.full((2, max(len(side) for side in self.below) + 1, 2), -1, dtype=np.int64)
        for rows, side in zip(below, self.below):
            rows[: len(side)] = np.array(side, dtype=np.int64).reshape(-1, 2)
        return np.array(self.joints, dtype=np.int64), below

    def chain(self, skeleton: Skeleton) -> np.ndarray:
        """(b, 3) those rows of the skeleton's chain that the legs hang on."""
        needed = {joint for leg in self.joints for toe in leg for joint in (toe, *_up(skeleton, toe))}
        return np.ascontiguousarray(skeleton.chain[[int(child) in needed for child in skeleton.chain[:, 2]]])

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
    from emulator.kernels.limbs import wanting_all

    room = np.empty(len(joints_m))
    wanting_all(joints_m, ankles_m, legs.tables[0], _by_joint(bone_m, joints_m), room)
    return room


def stand_on(
    joints_m: np.ndarray, ankles_m: np.ndarray, feet: np.ndarray, legs: Legs, bone_m: Mapping[int, float]
) -> np.ndarray:
    """Joints (T, J, 3) with the ankles at ankles_m (T, 2, 3), feet along unit vectors (T, 2, 3), knees on their side.

    bone_m : length of the bone that ends in a joint. An ankle out of reach is approached to ``limbs.REACH`` of the leg.
    """
    from emulator.kernels import limbs

    out = np.empty(joints_m.shape)
    limbs.stand_on(joints_m, ankles_m, feet, *legs.tables, _by_joint(bone_m, joints_m), out)
    return out


def _by_joint(bone_m: Mapping[int, float], joints_m: np.ndarray) -> np.ndarray:
    """(J,) length of the bone that ends in a joint, 0 for the root."""
    return np.array([bone_m.get(joint, 0.0) for joint in range(joints_m.shape[1])])
