"""BVH written: a file as it was read, or joints through time as a hierarchy with rotations."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import IO

import numpy as np

from emulator.motion import Motion
from emulator.recordings.bvh import BvhFile
from emulator.recordings.take import Take

DECIMALS = 7
"""Of centimetres and degrees: joints come back to 1e-8 m."""
UNIT_M = 0.01
_UNEVEN = 1e-6


def write_bvh(motion: Motion | Take, path: str | Path) -> None:
    """Joints through time as BVH in centimetres, Y up; on re-reading every joint is where it was to 1e-6 m.

    The root has six channels, the others three rotations, and position channels where a joint does not move rigidly
    with its parent (bones that breathe, or several children that move against each other). The rest posture is a
    T where the joints' names say what they are. Raises ValueError for markers, gaps, and uneven frames.
    """
    from emulator.recordings.bvh_pose import bvh_of

    take = motion if isinstance(motion, Take) else _take(motion)
    write_bvh_file(bvh_of(take, UNIT_M), path, decimals=DECIMALS)


def write_bvh_file(file: BvhFile, path: str | Path, *, decimals: int | None = None) -> None:
    """A BVH file; ``decimals`` None writes the shortest digits that read back as the same numbers.

    Raises ValueError for values that are not finite or do not fit the channels; OSError where nothing can be written.
    """
    path = Path(path)
    n_channels = sum(map(len, file.channels))
    if np.shape(file.values)[1:] != (n_channels,) or not len(file.values):
        raise ValueError(f"{path}: found values {np.shape(file.values)}, expected (T, {n_channels}) with a frame")
    if not np.all(np.isfinite(file.values)) or not np.all(np.isfinite(file.offsets)):
        raise ValueError(f"{path}: found values that are not finite, expected numbers")
    part = path.with_name(path.name + ".part")
    try:
        with part.open("w", encoding="utf-8", newline="\n") as out:
            _write(file, out, decimals)
        part.replace(path)
    except OSError as error:
        with suppress(OSError):
            part.unlink()
        raise OSError(error.errno, error.strerror, str(path)) from None


def _write(file: BvhFile, out: IO[str], decimals: int | None) -> None:
    order = []
    out.write("HIERARCHY\n")
    for joint, line in _hierarchy(file):
        out.write(line + "\n")
        if joint is not None:
            order.append(joint)
    starts = np.cumsum([0, *map(len, file.channels)])
    columns = np.concatenate([np.arange(starts[j], starts[j + 1]) for j in order]).astype(int)
    out.write(f"MOTION\nFrames: {len(file.values)}\nFrame Time: {_plain(file.frame_time_s)}\n")
    row_form = " ".join([f"%.{decimals}f"] * len(columns)) + "\n"
    for row in file.values:
        values = row[columns].tolist()
        out.write(" ".join(map(_plain, values)) + "\n" if decimals is None else row_form % tuple(values))


def _hierarchy(file: BvhFile) -> Iterator[tuple[int | None, str]]:
    """(joint where one begins, line), depth first; a list of what is still open, not recursion."""
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(file.parents):
        children.setdefault(parent, []).append(joint)
    waiting: list[tuple[int, int]] = [(joint, 0) for joint in reversed(children.get(-1, []))]
    while waiting:
        joint, depth = waiting.pop()
        tab = "\t" * depth
        if joint < 0:
            yield None, f"{tab}}}"
            continue
        yield joint, f"{tab}{'JOINT' if depth else 'ROOT'} {_word(file.names[joint])}"
        yield None, f"{tab}{{\n{tab}\tOFFSET {_numbers(file.offsets[joint])}"
        yield None, " ".join([f"{tab}\tCHANNELS {len(file.channels[joint])}", *file.channels[joint]])
        for parent, offset in zip(file.end_parents, file.end_offsets):
            if parent == joint:
                yield None, f"{tab}\tEnd Site\n{tab}\t{{\n{tab}\t\tOFFSET {_numbers(offset)}\n{tab}\t}}"
        waiting.append((-1, depth))
        waiting += [(child, depth + 1) for child in reversed(children.get(joint, []))]


def _numbers(values: np.ndarray) -> str:
    return " ".join(map(_plain, values.tolist()))


def _plain(value: float) -> str:
    """The shortest digits that read back as this number, without an exponent: some importers know none."""
    text = repr(float(value))
    return np.format_float_positional(value, trim="0") if "e" in text else text


def _word(name: str) -> str:
    return "".join(" " if c.isspace() else "_" if c in "{}" else c for c in name) or "joint"


def _take(motion: Motion) -> Take:
    step_s = np.diff(motion.time_s)
    if np.ptp(step_s) > _UNEVEN * motion.duration_s:
        raise ValueError(
            f"motion {motion.name}: found frames {step_s.min():g} to {step_s.max():g} s apart, expected even"
        )
    return Take(
        motion.skeleton.names,
        motion.skeleton.parents,
        motion.positions_m(world=True),
        round(len(step_s) / motion.duration_s, 9),
        worker=motion.worker,
        trial=motion.trial,
    )
