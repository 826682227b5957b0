"""How people stand who perform nothing that is known: upright, arms hanging."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from opsim.plan import Plan
from opsim.viewer.scene import Standing
from opsim.viewer.skeletons import Tree, hung, tree_of
from opsim.viewer.walked import bones_m

_MIDDLE = {"spine": (0.02, 0, 1), "chest": (0.03, 0, 1), "neck": (0.03, 0, 1), "head": (0.25, 0, 1)}
_LEFT = {
    "clavicle": (0, 1, 0.2), "shoulder": (0, 0.75, 0.67), "elbow": (0, 0.2, -1), "wrist": (0.22, -0.02, -1),
    "hand": (0.22, -0.02, -1), "fingers": (0.22, -0.02, -1), "hip": (0, 0.89, -0.45), "knee": (0.02, 0.02, -1),
    "ankle": (-0.03, 0, -1), "toe": (0.92, 0.16, -0.35), "foot": (0.92, 0.16, -0.35), "heel": (-0.5, 0, -1),
}  # fmt: skip
"""Ahead, to the left, up; those of the right side are mirrored. Of the made library's people before they reach."""
NOBODYS = SimpleNamespace(names=("pelvis", "chest"), parents=(-1, 0))
"""The skeleton where nobody works."""


def standing(plan: Plan, replication: int) -> Standing:
    """The posture and each worker's bones: those with which he walks."""
    found = [bones_m(plan, replication, rank) for rank in range(len(plan.workers))]
    skeleton = found[0][0] if found else NOBODYS
    directions = standing_directions(tree_of(skeleton))
    return Standing(skeleton, directions, np.array([bones for _, bones in found]).reshape(len(found), len(directions)))


def standing_directions(tree: Tree) -> np.ndarray:
    """(B, 3) unit vectors of a skeleton's bones, by the names of the joints where they end; unknown ones point up."""
    names, parents = tree
    vectors = np.array([_vector(name) for name, parent in zip(names, parents) if parent >= 0], dtype=float)
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _vector(name: str) -> tuple[float, float, float]:
    side, _, limb = name.partition("_")
    if side in ("left", "right") and limb in _LEFT:
        x, y, z = _LEFT[limb]
        return x, y if side == "left" else -y, z
    return _MIDDLE.get(name, (0.0, 0.0, 1.0))


def root_height_m(directions: np.ndarray, bone_m: np.ndarray, skeleton: Any) -> float:
    """How high the root is when the lowest joint stands on the floor."""
    return float(-hung(directions, bone_m, np.zeros(3), tree_of(skeleton)[1])[:, 2].min())
