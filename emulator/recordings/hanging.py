"""On which joint each joint hangs: as in the file with what was left out bridged, or as bodies are made."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

_TRUNK = ("pelvis", "spine", "chest", "upper_chest", "neck", "mid_neck", "upper_neck", "head")
_LIMBS = {
    "clavicle": ("upper_chest", "chest", "neck", "spine", "pelvis"),
    "shoulder": ("clavicle", "upper_chest", "chest", "neck", "spine", "pelvis"),
    "elbow": ("shoulder",),
    "wrist": ("elbow",),
    "hand": ("wrist", "elbow"),
    "fingers": ("hand", "wrist"),
    "thumb": ("hand", "wrist"),
    "hip": ("pelvis",),
    "knee": ("hip",),
    "ankle": ("knee",),
    "foot": ("ankle",),
    "toe": ("foot", "ankle"),
    "heel": ("ankle", "foot"),
}
_COINCIDENT_M = 1e-3
_FIRST = (
    "pelvis", "neck", "hip", "shoulder", "knee", "elbow", "ankle", "wrist", "head", "toe", "hand", "spine", "chest",
)  # fmt: skip
"""Of two joints at one place the one that comes first here stays."""


def hung_as_bodies_are(joints: Sequence[str]) -> tuple[int, ...]:
    """Parents of joints that have none: the nearest joint there is on the way to the pelvis, which is the root."""
    return tuple(joints.index(parent) if (parent := _nearest(joint, joints)) else -1 for joint in joints)


def _nearest(joint: str, joints: Sequence[str]) -> str:
    side, _, limb = joint.partition("_")
    if joint in _TRUNK:
        below = reversed(_TRUNK[: _TRUNK.index(joint)])
        return next((each for each in below if each in joints), "")
    for above in _LIMBS[limb]:
        for name in (f"{side}_{above}", above):
            if name in joints:
                return name
    return "pelvis"


def hung_as_in_the_file(parents: Sequence[int], at: Sequence[int]) -> tuple[int, ...] | None:
    """Parents among the kept joints ``at`` (numbers in the file); children of others hang on their nearest ancestor.

    None where more than one of them would be a root.
    """
    place = {joint: i for i, joint in enumerate(at)}
    kept = []
    for joint in at:
        above = parents[joint]
        while above >= 0 and above not in place:
            above = parents[above]
        kept.append(place.get(above, -1))
    return tuple(kept) if kept.count(-1) == 1 else None


def depths(parents: Sequence[int]) -> list[int]:
    """Joints from the root to each joint."""

    def depth(joint: int) -> int:
        steps = 0
        while parents[joint] >= 0 and steps <= len(parents):
            joint, steps = parents[joint], steps + 1
        return steps

    return [depth(joint) for joint in range(len(parents))]


def without_length(joints: Sequence[str], parents: Sequence[int], positions_m: np.ndarray) -> list[int]:
    """Numbers of the joints to leave out because they lie where their parent is (T, J, 3): no bone is without length.

    Of the two the one that is needed more stays.
    """
    out: list[int] = []
    for joint in sorted(range(len(joints)), key=depths(parents).__getitem__):
        parent = parents[joint]
        while parent in out:
            parent = parents[parent]
        if parent < 0:
            continue
        apart = np.linalg.norm(positions_m[:, joint] - positions_m[:, parent], axis=-1)
        seen = apart[np.isfinite(apart)]
        if len(seen) and np.median(seen) < _COINCIDENT_M:
            out.append(max(joint, parent, key=lambda j: _rank(joints[j])))
    return out


def _rank(joint: str) -> int:
    word = joint.removeprefix("left_").removeprefix("right_")
    return _FIRST.index(word) if word in _FIRST else len(_FIRST)
