"""AMC: for each frame the values of each bone, a line a bone.

ASF/AMC (Acclaim): a skeleton file, and beside it a motion file with the angles of each bone in each frame.

Source: the Acclaim format as HDM05 and CMU use it. Bone X of parent P ends at p(P) + R(X) d, where R(X) = R(P) C L C'
with the bone's axes C and its turns L; joint X is the end of bone X. In the order XYZ the turn about x comes first:
L = Lz Ly Lx.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from emulator.recordings.acclaim import INCH_M, Acclaim, Bone, read_asf
from emulator.recordings.take import Take
from emulator.recordings.text import RecordingError, finite, quoted, refuse_swelling, text_lines


@dataclass(frozen=True, eq=False)
class AmcValues:
    """``values`` (T, C) in the order of the skeleton's bones and freedoms; ``rate_hz`` None where none is said."""

    values: np.ndarray
    in_degrees: bool = True
    rate_hz: float | None = None


def read_amc_values(path: str | Path, skeleton: Acclaim) -> AmcValues:
    """All frames. Raises RecordingError with file, line, what was found and expected, at the first mistake."""
    return _Reader(Path(path), skeleton).read()


class _Reader:
    """A frame is filled bone by bone and joins the others once it is whole: memory follows what the file holds."""

    def __init__(self, path: Path, skeleton: Acclaim) -> None:
        self.path, self.line = path, 1
        self.in_degrees = True
        self.rate_hz: float | None = None
        self.places: dict[str, tuple[int, int]] = {}
        at = 0
        for bone in skeleton.bones:
            if bone.dof:
                self.places[bone.name] = (at, len(bone.dof))
            at += len(bone.dof)
        self.known = skeleton.names
        self.values = array("d")
        self.frame = [0.0] * at
        self.told: set[str] = set()
        self.number: int | None = None

    def read(self) -> AmcValues:
        for line, text in text_lines(self.path):
            self.line = line
            words = text.split()
            if not words or words[0].startswith("#"):
                continue
            if words[0].startswith(":"):
                self._directive(words)
            elif len(words) == 1 and words[0].isascii() and words[0].isdigit():
                self._next_frame(words[0])
            else:
                self._bone(words)
        if self.number is None:
            self._stop("found no frame, expected a line with its number")
        self._finish()
        if not self.frame:
            self._stop("found a skeleton without freedoms, expected those of the root at least")
        values = np.frombuffer(self.values, float).reshape(-1, len(self.frame))
        return AmcValues(values, self.in_degrees, self.rate_hz)

    def _directive(self, words: list[str]) -> None:
        key = words[0].upper()
        if key == ":RADIANS":
            self.in_degrees = False
        elif key == ":SAMPLES-PER-SECOND":
            rate = finite(words[1]) if len(words) == 2 else None
            if rate is None or rate <= 0:
                self._stop(f"found {quoted(' '.join(words[1:]))} samples a second, expected a positive number")
            self.rate_hz = rate

    def _next_frame(self, word: str) -> None:
        number = int(word) if len(word) < 19 else -1
        if self.number is not None:
            self._finish()
            if number != self.number + 1:
                self._stop(f"found frame {quoted(word)} after {self.number}, expected {self.number + 1}")
        self.number = number

    def _finish(self) -> None:
        """The frame that ends here has every bone."""
        if len(self.told) < len(self.places):
            missing = [name for name in self.places if name not in self.told]
            some = ", ".join(missing[:3]) + ", ..." * (len(missing) > 3)
            self._stop(f"found the end of frame {self.number} without {some}, expected all {len(self.places)} bones")
        self.values.extend(self.frame)
        self.told.clear()

    def _bone(self, words: list[str]) -> None:
        name = words[0]
        place = self.places.get(name)
        if self.number is None:
            self._stop(f"found {quoted(' '.join(words))}, expected a frame's number first")
        if place is None:
            self._stop(f"found {quoted(name)}, {self._expected(name)}")
            return
        if name in self.told:
            self._stop(f"found {quoted(name)} again in frame {self.number}, expected each bone once")
        at, count = place
        if len(words) != count + 1:
            self._stop(f"found {len(words) - 1} values of {quoted(name)}, expected {count}")
        self.frame[at : at + count] = self._numbers(words[1:])
        self.told.add(name)

    def _numbers(self, words: list[str]) -> Iterator[float]:
        for word in words:
            value = finite(word)
            if value is None:
                self._stop(f"found {quoted(word)}, expected a number")
            yield value or 0.0

    def _expected(self, name: str) -> str:
        if name in self.known:
            return "expected no values: the skeleton gives this bone no dof"
        near = get_close_matches(name, self.places, n=1)
        return f"did you mean {near[0]!r}?" if near else f"expected one of {', '.join(list(self.places)[:6])}, ..."

    def _stop(self, what: str) -> None:
        raise RecordingError(f"{self.path}:{self.line}: {what}")


USUAL_RATE_HZ = 120.0


def read_amc(
    path: str | Path,
    *,
    asf: str | Path | None = None,
    unit_m: float | None = None,
    up: str | None = None,
    rate_hz: float | None = None,
) -> Take:
    """The ends of all bones through time, "root" first, in metres, z up.

    asf     : the skeleton; None takes the one beside it that fits by name, or the only one there
    unit_m  : metres of one unit of length; None: 0.0254 / (length of :units), the convention of HDM05 and CMU
    up      : None: y, as the format has it
    rate_hz : None: what the file says, else 120 (an AMC seldom says)
    Raises RecordingError with file, line, what was found and expected.
    """
    from emulator.recordings.orientation import placed

    path = Path(path)
    skeleton_path = _skeleton_beside(path) if asf is None else Path(asf)
    skeleton = read_asf(skeleton_path)
    values = read_amc_values(path, skeleton)
    refuse_swelling(path, len(values.values), len(skeleton.bones))
    positions = amc_positions(skeleton, values)
    notes = [f"skeleton from {skeleton_path.name}", *_notes(skeleton)]
    if unit_m is None:
        unit_m = INCH_M / skeleton.length_unit
        notes.append(f"unit of length 1/{skeleton.length_unit:g} inch = {unit_m:.6g} m, as HDM05 and CMU write it")
    if up is None:
        up = "y"
        notes.append("y taken as up")
    if rate_hz is None:
        rate_hz = values.rate_hz or USUAL_RATE_HZ
        said = "as the file says" if values.rate_hz else "assumed: the file does not say"
        notes.append(f"{rate_hz:g} frames a second {said}")
    metres, more = placed(positions, skeleton.names, unit_m=unit_m, up=up, where=str(path))
    return Take(skeleton.names, skeleton.parents, metres, rate_hz, trial=path.stem, notes=(*notes, *more))


def amc_positions(skeleton: Acclaim, amc: AmcValues) -> np.ndarray:
    """Ends of the bones (T, J, 3) in the unit of the file."""
    from emulator.kernels.bodies import walk

    radian = np.degrees(1.0)
    offsets = np.array([np.multiply(bone.direction, bone.length) for bone in skeleton.bones])
    axes = np.array([_axes(bone, 1.0 if skeleton.in_degrees else radian) for bone in skeleton.bones])
    first, column, kind = [0], [], []
    at = 0
    for bone in skeleton.bones:
        steps = _steps(bone, at)
        column += [c for c, _ in steps]
        kind += [k for _, k in steps]
        at += len(bone.dof)
        first.append(len(kind))
    values = amc.values
    turning = np.array([c for c, k in zip(column, kind) if k >= 3], np.int64)
    if not amc.in_degrees:
        values = values.copy()
        values[:, turning] *= radian
    joints = np.empty((len(values), len(skeleton.bones), 3))
    order = np.array(list(_outwards(skeleton.parents)), np.int64)
    numbers = [np.array(column_or_kind, np.int64) for column_or_kind in (first, column, kind)]
    walk(values, order, np.array(skeleton.parents, np.int64), *numbers, offsets, axes, True, joints)
    return joints


def _steps(bone: Bone, at: int) -> list[tuple[int, int]]:
    """(column, kind) of a bone's values from column ``at`` on; the turn that comes first is the innermost."""
    places = {word: at + i for i, word in enumerate(bone.dof)}
    moves = [(places[f"t{axis}"], k) for k, axis in enumerate("xyz") if f"t{axis}" in places]
    turns = [(places[f"r{axis}"], 3 + "xyz".index(axis)) for axis in reversed(bone.order) if f"r{axis}" in places]
    return moves + turns


def _axes(bone: Bone, to_degrees: float) -> np.ndarray:
    """The bone's axes, (3, 3)."""
    turned = np.eye(3)
    for axis, angle in zip(bone.order, bone.axis):
        a = np.radians(angle * to_degrees)
        k = "xyz".index(axis)
        i, j = (k + 1) % 3, (k + 2) % 3
        turn = np.eye(3)
        turn[[i, i, j, j], [i, j, i, j]] = np.cos(a), -np.sin(a), np.sin(a), np.cos(a)
        turned = turn @ turned
    return turned


def _outwards(parents: tuple[int, ...]) -> Iterator[int]:
    """Joints with parents before children."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(parents):
        children.setdefault(parent, []).append(joint)
    waiting = [0]
    while waiting:
        joint = waiting.pop()
        yield joint
        waiting += children.get(joint, ())


def _skeleton_beside(path: Path) -> Path:
    """The ASF of the same name, or whose name this one begins with (the longest), or the only one in the folder."""
    there = sorted(p for p in path.parent.glob("*") if p.suffix.lower() == ".asf")
    named = [p for p in there if path.stem.lower().startswith(p.stem.lower())]
    if named:
        return max(named, key=lambda p: len(p.stem))
    if len(there) == 1:
        return there[0]
    found = ", ".join(p.name for p in there[:3]) + ", ..." * (len(there) > 3) if there else "none"
    raise RecordingError(f"{path}: found {found} beside it, expected its skeleton (.asf); name it with --asf")


def _notes(skeleton: Acclaim) -> list[str]:
    root = skeleton.bones[0]
    notes = []
    if any(root.direction) or any(root.axis):
        notes.append("the skeleton's root has a position or orientation of its own, which is added")
    if odd := [bone.name for bone in skeleton.bones if bone.order != "xyz"]:
        notes.append(f"turns of {', '.join(odd[:3])} in another order than XYZ")
    return notes
