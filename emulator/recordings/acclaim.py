"""A skeleton as Acclaim files describe it: bones with their own axes and freedoms.

The hierarchy of an Acclaim skeleton: is every bone below the root?

ASF: the skeleton of an Acclaim recording, with each bone's axes and freedoms.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from emulator.recordings.bvh_header import MOST_JOINTS, MOST_TOLD
from emulator.recordings.text import RecordingError, finite, quoted, text_lines

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


def hung_on_root(bones: Sequence[str], parent: Mapping[str, str]) -> tuple[tuple[int, ...], dict[str, str]]:
    """Parents by number, the root first, and for each bone that does not hang on the root what is wrong with it.

    parent : the parent of each bone by name; a bone may be missing, or be its own ancestor. Each is looked at once.
    """
    numbers = {name: i for i, name in enumerate((ROOT, *bones))}
    seen, loose = {ROOT}, {}
    for name in bones:
        path: dict[str, None] = {}
        at = name
        while at not in seen and at not in path and at in parent:
            path[at] = None
            at = parent[at]
        if at in path:
            loose[at] = f"found {quoted(at)} to be its own ancestor, expected a tree below the root"
        elif at not in seen:
            path[at] = None
            loose[at] = f"found {quoted(at)} below no bone, expected it in :hierarchy"
        seen.update(path)
    return (-1, *(numbers[parent[name]] for name in bones if name in parent)), loose


_UNREAD = ("version", "name", "documentation", "skin", "comments")
_SECTIONS = (*_UNREAD, "units", "root", "bonedata", "hierarchy")


def read_asf(path: str | Path) -> Acclaim:
    """The skeleton. Raises RecordingError with all mistakes: file, line, what was found and expected."""
    return _Reader(Path(path)).read()


@dataclass
class _Reader:
    """Words of a section in, bones out; mistakes are kept with their lines."""

    path: Path
    section: str = ""
    line: int = 1
    bones: dict[str, Bone] = field(default_factory=dict)
    current: Bone | None = None
    root: Bone = field(
        default_factory=lambda: Bone(ROOT, 1, (0.0, 0.0, 0.0), 1.0, dof=("tx", "ty", "tz", "rx", "ry", "rz"))
    )
    parent: dict[str, tuple[str, int]] = field(default_factory=dict)
    length_unit: float = 1.0
    in_degrees: bool = True
    seen: set[str] = field(default_factory=set)
    mistakes: list[str] = field(default_factory=list)

    def read(self) -> Acclaim:
        for line, text in text_lines(self.path):
            self.line = line
            words = text.partition("#")[0].split()
            if words and words[0].startswith(":"):
                self._begin(words)
            elif words:
                self._statement(words)
        for needed in ("root", "bonedata", "hierarchy"):
            if needed not in self.seen and not self.mistakes:
                self._wrong(f"found the end without :{needed}, expected an ASF skeleton")
        if self.current is not None:
            self._wrong(f"found no end of bone {quoted(self.current.name)}, expected 'end'")
        parents = () if self.mistakes else self._parents()
        if self.mistakes:
            raise RecordingError("\n".join(self.mistakes))
        return Acclaim((self.root, *self.bones.values()), parents, self.length_unit, self.in_degrees)

    def _begin(self, words: list[str]) -> None:
        self.section = words[0][1:].lower()
        if self.section not in _SECTIONS and not self.seen:
            self._wrong(f"found {quoted(words[0])}, expected one of :{', :'.join(_SECTIONS)}")
        self.seen.add(self.section)

    def _statement(self, words: list[str]) -> None:
        if self.section == "units":
            self._unit(words)
        elif self.section == "root":
            self._root(words)
        elif self.section == "bonedata":
            self._bone(words)
        elif self.section == "hierarchy" and words[0].lower() not in ("begin", "end"):
            self._children(words)
        elif not self.section:
            self._wrong(f"found {quoted(' '.join(words))}, expected an ASF skeleton that begins with :version")
            self.section = "skin"

    def _unit(self, words: list[str]) -> None:
        key = words[0].lower()
        if key == "length":
            (length_unit,) = self._numbers(words, 1)
            if length_unit <= 0:
                self._wrong(f"length: found {length_unit:g}, expected a positive number")
            self.length_unit = length_unit
        elif key == "angle":
            self.in_degrees = not words[-1].lower().startswith("rad")

    def _root(self, words: list[str]) -> None:
        key = words[0].lower()
        if key == "order":
            self.root = replace(self.root, line=self.line, dof=self._freedoms(words[1:], (*MOVES, *TURNS)))
        elif key == "axis":
            self.root = replace(self.root, order=self._order(words[-1]))
        elif key == "position":
            self.root = replace(self.root, direction=self._numbers(words, 3))
        elif key == "orientation":
            self.root = replace(self.root, axis=self._numbers(words, 3))

    def _bone(self, words: list[str]) -> None:
        key = words[0].lower()
        if key == "begin":
            if self.current is not None:
                self._wrong(f"found 'begin' in bone {quoted(self.current.name)}, expected 'end' first")
            self.current = Bone("", self.line)
        elif self.current is None:
            self._wrong(f"found {quoted(words[0])}, expected 'begin'")
        elif key == "end":
            self._close(self.current)
        elif key in _BONE:
            _BONE[key](self, words)

    def _close(self, bone: Bone) -> None:
        if not bone.name:
            self._wrong("found a bone without a name, expected 'name'")
        elif bone.name in self.bones or bone.name == ROOT:
            where = f" (one begins in line {self.bones[bone.name].line})" if bone.name in self.bones else ""
            self._wrong(f"found bone {quoted(bone.name)} again, expected each name once{where}")
        if bone.length < 0 or not bone.direction:
            missing = "length" if bone.length < 0 else "direction"
            self._wrong(f"found no {missing} of bone {quoted(bone.name)}, expected one")
        self.bones[bone.name] = bone
        self.current = None
        if len(self.bones) > MOST_JOINTS:
            self._wrong(f"found more than {MOST_JOINTS:,} bones, expected a body")
            raise RecordingError("\n".join(self.mistakes))

    def _set(self, **values: Any) -> None:
        if self.current is not None:
            self.current = replace(self.current, **values)

    def _name(self, words: list[str]) -> None:
        self._set(name=" ".join(words[1:]))

    def _direction(self, words: list[str]) -> None:
        self._set(direction=self._numbers(words, 3))

    def _length(self, words: list[str]) -> None:
        (length,) = self._numbers(words, 1)
        if length < 0:
            self._wrong(f"length: found {length:g}, expected 0 or more")
        self._set(length=abs(length))

    def _axis(self, words: list[str]) -> None:
        self._set(axis=self._numbers(words[:4], 3), order=self._order(words[4]) if len(words) > 4 else "xyz")

    def _dof(self, words: list[str]) -> None:
        self._set(dof=self._freedoms(words[1:], TURNS))

    def _children(self, words: list[str]) -> None:
        for name in words:
            if name not in self.bones and name != ROOT:
                near = get_close_matches(name, [ROOT, *self.bones], n=1)
                self._wrong(f"found no bone {quoted(name)}{f'; did you mean {near[0]!r}?' if near else ''}")
        for child in words[1:]:
            if child in self.parent or child == ROOT:
                has = f"below {quoted(self.parent[child][0])}" if child in self.parent else "at the top"
                self._wrong(f"found {quoted(child)} below {quoted(words[0])}, expected it once: it is {has}")
            self.parent[child] = (words[0], self.line)

    def _parents(self) -> tuple[int, ...]:
        parents, loose = hung_on_root(tuple(self.bones), {name: at[0] for name, at in self.parent.items()})
        for name, why in loose.items():
            self._told(self.parent[name][1] if name in self.parent else self.bones[name].line, why)
        return parents

    def _numbers(self, words: list[str], count: int) -> tuple[float, ...]:
        values = [finite(word) for word in words[1:]]
        if len(values) != count or None in values:
            self._wrong(f"{words[0]}: found {quoted(' '.join(words[1:]))}, expected {count} number{'s' * (count > 1)}")
            return (1.0,) * count
        return tuple(value for value in values if value is not None)

    def _order(self, word: str) -> str:
        if sorted(word.lower()) != ["x", "y", "z"]:
            self._wrong(f"axis: found {quoted(word)}, expected an order such as XYZ")
            return "xyz"
        return word.lower()

    def _freedoms(self, words: list[str], known: tuple[str, ...]) -> tuple[str, ...]:
        freedoms = tuple(word.lower() for word in words)
        unknown = [word for word in freedoms if word not in known]
        if unknown or len(set(freedoms)) < len(freedoms):
            self._wrong(f"found freedoms {quoted(' '.join(words))}, expected some of {', '.join(known)}, each once")
            return ()
        return freedoms

    def _wrong(self, what: str) -> None:
        self._told(self.line, what)

    def _told(self, line: int, what: str) -> None:
        self.mistakes.append(f"{self.path}:{line}: {what}")
        if len(self.mistakes) >= MOST_TOLD:
            raise RecordingError("\n".join(self.mistakes))


_BONE: dict[str, Callable[[_Reader, list[str]], None]] = {
    "name": _Reader._name,
    "direction": _Reader._direction,
    "length": _Reader._length,
    "axis": _Reader._axis,
    "dof": _Reader._dof,
}
