"""ASF/AMC (Acclaim): a skeleton file, and beside it a motion file with the angles of each bone in each frame.

Source: the Acclaim format as HDM05 and CMU use it. Bone X of parent P ends at p(P) + R(X) d, where R(X) = R(P) C L C'
with the bone's axes C and its turns L; joint X is the end of bone X. In the order XYZ the turn about x comes first:
L = Lz Ly Lx.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.acclaim import INCH_M, Acclaim, Bone
from emulator.recordings.amc import AmcValues, read_amc_values
from emulator.recordings.asf import read_asf
from emulator.recordings.take import Take
from emulator.recordings.text import refuse_swelling

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
    from emulator.recordings.axes import placed

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
    from emulator.kernels.hierarchy import walk

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
