"""A skeleton as Acclaim files describe it: bones with their own axes and freedoms."""

from __future__ import annotations

from dataclasses import dataclass

INCH_M = 0.0254
ROOT = "root"
TURNS, MOVES = ("rx", "ry", "rz"), ("tx", "ty", "tz")


@dataclass(frozen=True)
class Bone:
    """A bone from its parent's end: ``direction`` and ``length`` in the file's unit, its axes in degrees, its freedoms.

    ``axis`` are turns about ``order`` (such as "xyz", the first turned first); ``dof`` words such as "rx".
    """

    name: str
    line: int
    direction: tuple[float, ...] = ()
    length: float = -1.0
    axis: tuple[float, ...] = (0.0, 0.0, 0.0)
    order: str = "xyz"
    dof: tuple[str, ...] = ()


@dataclass(frozen=True)
class Acclaim:
    """An ASF file: ``bones`` with the root first, ``parents`` in that order.

    length_unit : what lengths are divided by to get inches; in_degrees: the skeleton's own angles
    The root's ``direction`` is its place (its length is 1), its ``axis`` its orientation, its ``dof`` the order of
    values in the AMC.
    """

    bones: tuple[Bone, ...]
    parents: tuple[int, ...]
    length_unit: float = 1.0
    in_degrees: bool = True

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(bone.name for bone in self.bones)
