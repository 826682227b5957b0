"""A skeleton: joints, parents, and the way between joint positions and unit directions of its bones.

Source: Chen, Park & Srivastava, sec. 3.1: landmarks -> vectors from the parent -> unit vectors.
Place, size and proportions drop out.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cached_property

import numpy as np

_TRUNK = ("pelvis", "spine", "chest", "neck", "head")
_ARM = ("shoulder", "elbow", "wrist", "hand")
_LEG = ("hip", "knee", "ankle", "toe")
CANONICAL = (
    *_TRUNK,
    *(f"{side}_{joint}" for limb in (_ARM, _LEG) for side in ("left", "right") for joint in limb),
)
"""The 21 joints that every reader maps to, in this order: trunk, left arm, right arm, left leg, right leg."""

EXTRA = (
    "upper_chest",
    "mid_neck",
    "upper_neck",
    *(f"{side}_{joint}" for side in ("left", "right") for joint in ("clavicle", "fingers", "thumb", "foot", "heel")),
)
"""Joints that some recordings have besides."""

# Other words for the middle, and for a limb without its side. HDM05 (ASF) names a joint after the bone that ENDS there.
_MIDDLE = {
    "hips": "pelvis", "root": "pelvis", "hip": "pelvis", "spine1": "chest", "spine2": "upper_chest",
    "lowerback": "spine", "upperback": "chest", "thorax": "neck", "c7": "neck", "lowerneck": "mid_neck",
    "upperneck": "upper_neck",
}  # fmt: skip
_LIMB = {
    "hipjoint": "hip", "femur": "knee", "tibia": "ankle", "toes": "toe", "toebase": "toe", "clavicle": "shoulder",
    "humerus": "elbow", "radius": "wrist", "collar": "clavicle", "arm": "shoulder", "upperarm": "shoulder",
    "forearm": "elbow", "lowerarm": "elbow", "upleg": "hip", "upperleg": "hip", "thigh": "hip", "leg": "knee",
    "lowerleg": "knee", "shin": "knee", "foot": "ankle",
}  # fmt: skip
_SIDE = re.compile(r"^(?:(left|right)|([lr]))(.+)$")
_SIDE_LAST = re.compile(r"^(.+?)(?:(left|right)|_([lr]))$")


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


_KNOWN = {_plain(name): name for name in (*CANONICAL, *EXTRA)} | _MIDDLE


def canonical_name(name: str) -> str:
    """The canonical name of a joint: ``lshoulder``, ``l_shoulder``, ``LeftShoulder`` -> ``left_shoulder``.

    Raises ValueError for an unknown name, with the nearest known one.
    """
    plain = _plain(name)
    if plain in _KNOWN:
        return _KNOWN[plain]
    for pattern, order in ((_SIDE_LAST, (2, 3, 1)), (_SIDE, (1, 2, 3))):
        found = pattern.match(re.sub(r"[^a-z0-9_]", "_", name.lower()))
        if found:
            word, letter, joint = (found.group(i) for i in order)
            side = word or {"l": "left", "r": "right"}[letter]
            joint = _plain(joint)
            full = _KNOWN.get(_plain(side + _LIMB.get(joint, joint)))
            if full:
                return full
    near = get_close_matches(plain, _KNOWN, n=1, cutoff=0.5)
    hint = f"did you mean {_KNOWN[near[0]]!r}?" if near else f"known: {', '.join((*CANONICAL, *EXTRA))}"
    raise ValueError(f"joint {name!r} is not known; {hint}")


# Whole skeletons speak a dialect. Where a joint is named after the bone that starts there, the shoulder is the collar
# bone and the hand the wrist; where after the bone that ends there (ASF), the foot ends before the toes.
_DIALECTS = (
    (("humerus", "femur"), {"foot": "foot"}),
    (("upperarm", "lowerarm", "forearm"), {"shoulder": "clavicle", "hand": "wrist"}),
)


def canonical_names(names: Sequence[str]) -> tuple[str, ...]:
    """Canonical names of one skeleton's joints, read together: ``Shoulder_L`` beside ``UpperArm_L`` is a collar bone.

    Raises ValueError for an unknown name.
    """
    said = " ".join(_plain(name) for name in names)
    dialect = next((words for signs, words in _DIALECTS if any(sign in said for sign in signs)), {})
    return tuple(_in_dialect(name, dialect) for name in names)


def _in_dialect(name: str, dialect: dict[str, str]) -> str:
    own = {_plain(side + word): joint for word, joint in dialect.items() for side in ("l", "r", "left", "right")}
    own |= {_plain(word + side): joint for word, joint in dialect.items() for side in ("l", "r", "left", "right")}
    canonical = canonical_name(name)
    joint = own.get(_plain(name))
    return f"{canonical.split('_')[0]}_{joint}" if joint else canonical


@dataclass(frozen=True)
class Skeleton:
    """Joints and their parents; ``parents[j]`` is -1 for the one root. Each other joint ends one bone, in joint order.

    Raises ValueError for double names, several roots, or a cycle.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(str(name) for name in self.names))
        object.__setattr__(self, "parents", tuple(int(parent) for parent in self.parents))
        if len(self.names) != len(self.parents) or len(self.names) < 2:
            raise ValueError(
                f"skeleton: {len(self.names)} names and {len(self.parents)} parents (one each, two at least)"
            )
        double = sorted({name for name in self.names if self.names.count(name) > 1})
        if double:
            raise ValueError(f"skeleton: joint {double[0]!r} is named twice")
        for name, parent in zip(self.names, self.parents):
            if not -1 <= parent < self.n_joints:
                numbers = f"a joint number from 0 to {self.n_joints - 1}, or -1 for none"
                raise ValueError(f"skeleton: joint {name!r}: found parent {parent}, expected {numbers}")
        roots = [name for name, parent in zip(self.names, self.parents) if parent == -1]
        if len(roots) > 1:
            raise ValueError(f"skeleton: joints {', '.join(roots)} have no parent (-1), expected one such joint")
        for joint in range(self.n_joints):
            self._path(joint)

    def _path(self, joint: int) -> list[int]:
        """The joints from ``joint`` up to, not including, the root."""
        path: list[int] = []
        while self.parents[joint] >= 0:
            if joint in path:
                circle = "is its own ancestor, expected a tree below one joint without parent (-1)"
                raise ValueError(f"skeleton: joint {self.names[joint]!r} {circle}")
            path.append(joint)
            joint = self.parents[joint]
        return path

    @property
    def n_joints(self) -> int:
        return len(self.names)

    @property
    def n_bones(self) -> int:
        return len(self.names) - 1

    @property
    def root(self) -> int:
        return self.parents.index(-1)

    @cached_property
    def bones(self) -> tuple[int, ...]:
        """The child joint of each bone, (B,)."""
        return tuple(j for j, parent in enumerate(self.parents) if parent >= 0)

    @property
    def bone_names(self) -> tuple[str, ...]:
        """A bone is named after the joint where it ends."""
        return tuple(self.names[j] for j in self.bones)

    @cached_property
    def other_side(self) -> tuple[int, ...]:
        """For each bone that of the other side; itself in the middle, or where the other side is not there."""
        names, swapped = self.bone_names, {"left_": "right_", "right_": "left_"}
        other = [next((to + n[len(side) :] for side, to in swapped.items() if n.startswith(side)), n) for n in names]
        return tuple(names.index(one) if one in names else i for i, one in enumerate(other))

    @property
    def edges(self) -> tuple[tuple[int, int], ...]:
        """(parent, child) joint numbers of each bone."""
        return tuple((self.parents[j], j) for j in self.bones)

    @cached_property
    def chain(self) -> np.ndarray:
        """(B, 3) bone, parent joint and child joint, from the root outwards: a parent comes before its children."""
        outwards = sorted(range(self.n_bones), key=lambda bone: len(self._path(self.bones[bone])))
        return np.array([(bone, *self.edges[bone]) for bone in outwards], dtype=np.int64)

    @cached_property
    def _reach(self) -> np.ndarray:
        """(J, B) 1 where the bone lies between the root and the joint."""
        reach = np.zeros((self.n_joints, self.n_bones))
        for joint in range(self.n_joints):
            reach[joint, self.lineage(joint)] = 1.0
        return reach

    def lineage(self, joint: int) -> list[int]:
        """The bones between a joint and the root."""
        return [self.bones.index(step) for step in self._path(joint)]

    def index(self, name: str) -> int:
        """The number of a joint, asked for by any alias. Raises ValueError if this skeleton has none such."""
        wanted = name if name in self.names else canonical_name(name)
        if wanted not in self.names:
            raise ValueError(f"this skeleton has no joint {wanted!r}; it has {', '.join(self.names)}")
        return self.names.index(wanted)

    def _vectors(self, positions: np.ndarray) -> np.ndarray:
        positions = np.asarray(positions, float)
        if positions.shape[-2:] != (self.n_joints, 3):
            raise ValueError(f"positions must be (..., {self.n_joints}, 3), found {positions.shape}")
        bones = list(self.bones)
        return positions[..., bones, :] - positions[..., [self.parents[j] for j in bones], :]

    def bone_lengths(self, positions: np.ndarray) -> np.ndarray:
        """Length of each bone, (..., J, 3) -> (..., B), in the unit of the positions."""
        return np.linalg.norm(self._vectors(positions), axis=-1)

    def directions(self, positions: np.ndarray) -> np.ndarray:
        """Unit vectors from parent to child, (..., J, 3) -> (..., B, 3).

        Raises ValueError that names joint and frame where a bone has no length or a position is not finite.
        """
        vectors = self._vectors(positions)
        lengths = np.linalg.norm(vectors, axis=-1)
        broken = ~(np.isfinite(lengths) & (lengths > 1e-9))
        if np.any(broken):
            *frame, bone = (int(i) for i in np.argwhere(broken)[0])
            at = f" at frame {frame[-1]}" if frame else ""
            found = "has no length" if np.isfinite(lengths[(*frame, bone)]) else "is not finite"
            raise ValueError(f"bone to joint {self.bone_names[bone]!r} {found}{at}")
        return vectors / lengths[..., None]

    def positions(self, directions: np.ndarray, bone_length_m: np.ndarray, root_m: np.ndarray) -> np.ndarray:
        """Joint positions (..., J, 3) from directions (..., B, 3), lengths (..., B) and the root's place (..., 3)."""
        steps = np.asarray(directions, float) * np.asarray(bone_length_m, float)[..., None]
        return self._reach @ steps + np.asarray(root_m, float)[..., None, :]


def standard_skeleton() -> Skeleton:
    """The canonical 21 joints with the parents used by the recordings: limbs hang on chest and pelvis."""
    hang = {"spine": "pelvis", "chest": "spine", "neck": "chest", "head": "neck"}
    for side in ("left", "right"):
        for limb, top in ((_ARM, "chest"), (_LEG, "pelvis")):
            chain = [top, *(f"{side}_{joint}" for joint in limb)]
            hang |= dict(zip(chain[1:], chain[:-1]))
    return Skeleton(CANONICAL, tuple(CANONICAL.index(hang[name]) if name in hang else -1 for name in CANONICAL))
