"""A skeleton as kernels read it: whole numbers only."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from opsim.ergonomics.joints import CANONICAL


def bone_chain(parents: Sequence[int]) -> np.ndarray:
    """(B, 3) bone, parent and child joint of each bone, from the root outwards: a parent comes before its children.

    Each joint but the root (parent -1) ends one bone; bones are numbered in the order of their joints.
    """
    joints = [joint for joint, parent in enumerate(parents) if parent >= 0]
    links = [(bone, parents[joint], joint) for bone, joint in enumerate(joints)]
    return np.array(sorted(links, key=lambda link: _depth(parents, link[2])), dtype=np.int64).reshape(-1, 3)


def joint_places(names: Sequence[str]) -> np.ndarray:
    """(21,) the number of each joint of ``CANONICAL`` among ``names`` (J,); J where it is missing."""
    number = {name: joint for joint, name in enumerate(names)}
    return np.array([number.get(name, len(names)) for name in CANONICAL], dtype=np.int64)


def _depth(parents: Sequence[int], joint: int) -> int:
    depth = 0
    while parents[joint] >= 0 and depth < len(parents):
        joint, depth = parents[joint], depth + 1
    return depth
