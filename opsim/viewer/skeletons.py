"""What the viewer needs of any emulator's bodies: chains of bones, directions, lengths, and the way of the root.

Named columns of numbers as one run of bytes, and back.

Little-endian, every column at a multiple of 8 bytes, in byte planes: the lowest byte of every number first, then the
next lowest. Neighbours are alike in their high bytes, so that the whole packs a quarter smaller.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

Tree = tuple[tuple[str, ...], tuple[int, ...]]
"""Names of the joints, and their parents; -1 of the root."""
_ABOVE = {
    "spine": "pelvis", "chest": "spine", "neck": "chest", "head": "neck", "shoulder": "chest", "elbow": "shoulder",
    "wrist": "elbow", "hand": "wrist", "hip": "pelvis", "knee": "hip", "ankle": "knee", "toe": "ankle",
}  # fmt: skip
"""Where the bones of an emulator hang that does not tell; canonical names without their side."""


def tree_of(skeleton: Any) -> Tree:
    """The joints of a skeleton and their parents, by its own word or by the names."""
    names = tuple(map(str, skeleton.names))
    if hasattr(skeleton, "parents"):
        return names, tuple(map(int, skeleton.parents))
    return names, tuple(_parent(name, names) for name in names)


def _parent(name: str, names: tuple[str, ...]) -> int:
    """The nearest joint above that is there; what is not known hangs on the first joint, which is the root."""
    side, _, limb = name.partition("_") if name.startswith(("left_", "right_")) else ("", "", name)
    while limb in _ABOVE:
        limb = _ABOVE[limb]
        for above in (f"{side}_{limb}", limb):
            if above in names:
                return names.index(above)
    return -1 if name == names[0] else 0


def chain_of(parents: tuple[int, ...]) -> list[tuple[int, int, int]]:
    """(bone, parent joint, child joint) from the root outwards; bone ``b`` ends at the b-th joint that has a parent."""
    bones = [joint for joint, parent in enumerate(parents) if parent >= 0]

    def depth(joint: int) -> int:
        return 0 if parents[joint] < 0 else 1 + depth(parents[joint])

    return [(bones.index(joint), parents[joint], joint) for joint in sorted(bones, key=depth)]


def hung(directions: np.ndarray, bone_m: np.ndarray, root_m: np.ndarray, parents: tuple[int, ...]) -> np.ndarray:
    """Joints (..., J, 3) below a root (..., 3), of directions (..., B, 3) and lengths (..., B)."""
    steps = directions * bone_m[..., None]
    joints = np.empty((*steps.shape[:-2], len(parents), 3))
    joints[..., parents.index(-1), :] = root_m
    for bone, parent, child in chain_of(parents):
        joints[..., child, :] = joints[..., parent, :] + steps[..., bone, :]
    return joints


def vectors_of(joints_m: np.ndarray, parents: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Directions (..., B, 3) and lengths (..., B) of joints (..., J, 3); a bone without length points up."""
    children = [joint for joint, parent in enumerate(parents) if parent >= 0]
    vectors = joints_m[..., children, :] - joints_m[..., [parents[joint] for joint in children], :]
    length = np.linalg.norm(vectors, axis=-1)
    up = np.array([0.0, 0.0, 1.0])
    return np.where(length[..., None] > 1e-9, vectors / np.maximum(length, 1e-9)[..., None], up), length


def turned(vectors: np.ndarray, yaw_rad: np.ndarray | float) -> np.ndarray:
    """Vectors (..., 3) turned about the vertical by angles that broadcast against (...)."""
    c, s = np.cos(yaw_rad), np.sin(yaw_rad)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([c * x - s * y, s * x + c * y, vectors[..., 2]], axis=-1)


def path_of(block: Any, times_s: np.ndarray) -> np.ndarray:
    """(n, T, 4) root in metres and heading of performances at times (n, T); heading 0 where it is not told."""
    if hasattr(block, "path"):
        return np.asarray(block.path(times_s=times_s))
    joints = np.asarray(block.positions_m(times_s=times_s))
    root = joints[:, :, tree_of(block.skeleton)[1].index(-1)]
    return np.concatenate([root, np.zeros((*root.shape[:2], 1))], axis=-1)


DTYPES = ("f8", "f4", "u4", "i4", "u2", "i2", "u1", "i1")
Table = dict[str, list]
"""name -> [dtype, offset in bytes, count]"""


class Columns:
    """Columns, one after the other."""

    def __init__(self) -> None:
        self.table: Table = {}
        self._parts: list[bytes] = []
        self._size = 0

    def add(self, name: str, dtype: str, values: np.ndarray) -> str:
        """One more, laid flat; its name. Raises ValueError for a name that is there, or a number that does not fit."""
        if name in self.table:
            raise ValueError(f"column {name}: it is there already")
        values = np.asarray(values).ravel()
        if dtype[0] in "iu" and values.size:
            room = np.iinfo(dtype)
            if not (room.min <= values.min() and values.max() <= room.max):
                raise ValueError(f"column {name}: {values.min():g} to {values.max():g} do not fit into {dtype}")
        packed = values.astype(f"<{dtype}")
        planes = packed.view(np.uint8).reshape(-1, packed.itemsize).T.tobytes()
        self.table[name] = [dtype, self._size, int(values.size)]
        padded = planes + bytes(-len(planes) % 8)
        self._parts.append(padded)
        self._size += len(padded)
        return name

    def close(self) -> bytes:
        """All of them."""
        return b"".join(self._parts)


def unpacked_columns(table: Mapping[str, list], data: bytes) -> dict[str, np.ndarray]:
    """The columns of a table, by name."""
    return {name: unpacked_column(data, *entry) for name, entry in table.items()}


def unpacked_column(data: bytes, dtype: str, offset: int, count: int) -> np.ndarray:
    """(count,) numbers of one column."""
    size = int(dtype[1])
    planes = np.frombuffer(data, np.uint8, count * size, offset).reshape(size, count)
    return np.ascontiguousarray(planes.T).reshape(-1).view(f"<{dtype}")
