"""BVH: a hierarchy of joints, and for each frame the values of their channels."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.bvh_header import CHANNELS, MOST_WORDS, HierarchyReader, words_of
from emulator.recordings.bvh_motion import opened, read_values
from emulator.recordings.take import Take
from emulator.recordings.text import refuse_swelling

WHOLE_RATE = 1e-9


@dataclass(frozen=True, eq=False)
class BvhFile:
    """A BVH file as it stands: lengths in its own unit, angles in degrees.

    names, parents : (J,) joints, parents before children, -1 for the root
    offsets        : (J, 3) from the parent
    channels       : (J,) for each joint its channels in the order of the file, such as ("Zrotation", "Xrotation")
    end_parents, end_offsets : (E,) and (E, 3) of the End Sites
    values         : (T, C) of all channels in order
    frame_time_s   : seconds from frame to frame, as written
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: np.ndarray
    channels: tuple[tuple[str, ...], ...]
    end_parents: tuple[int, ...]
    end_offsets: np.ndarray
    values: np.ndarray
    frame_time_s: float

    @property
    def rate_hz(self) -> float:
        return rate_of(self.frame_time_s)


def read_bvh_file(path: str | Path) -> BvhFile:
    """Any channel order, any number of channels a joint, position and rotation mixed, any encoding.

    Memory: the values and about two megabytes. Raises RecordingError with file, line, what was found and expected.
    """
    path = Path(path)
    head, blocks = opened(path)
    every = HierarchyReader(path, list(islice(words_of(head.hierarchy), MOST_WORDS))).read()
    joints = [joint for joint in every if not joint.is_end]
    number = {id(joint): i for i, joint in enumerate(joints)}
    ends = [joint for joint in every if joint.is_end]

    def parent_of(parent: int) -> int:
        return -1 if parent < 0 else number[id(every[parent])]

    return BvhFile(
        names=tuple(joint.name for joint in joints),
        parents=tuple(parent_of(joint.parent) for joint in joints),
        offsets=np.array([joint.offset for joint in joints], float).reshape(-1, 3),
        channels=tuple(joint.channels or () for joint in joints),
        end_parents=tuple(parent_of(end.parent) for end in ends),
        end_offsets=np.array([end.offset for end in ends], float).reshape(-1, 3),
        values=read_values(path, head, blocks, sum(len(joint.channels or ()) for joint in joints)),
        frame_time_s=head.frame_time_s,
    )


def read_bvh(path: str | Path, *, unit_m: float | None = None, up: str | None = None) -> Take:
    """The joints of a BVH file through time, in metres, z up.

    A position channel replaces the OFFSET along its axis (also of ROOT). An End Site is a joint named ``<parent>_end``;
    those without length are dropped. Unit and up axis are found from the body where they are not given, and the notes
    say what was found. Raises RecordingError as ``read_bvh_file``, and where the unit cannot be told.
    """
    from emulator.recordings.axes import placed

    path = Path(path)
    file = read_bvh_file(path)
    refuse_swelling(path, len(file.values), len(file.names) + len(file.end_parents))
    names, parents, positions = bvh_positions(file)
    if not np.all(np.isfinite(positions)):
        raise RecordingError(f"{path}: found positions beyond all numbers, expected a body")
    rate_hz, notes = file.rate_hz, _notes(file, names)
    del file  # its values are as large as the joints, which are copied now
    metres, found = placed(positions, names, unit_m=unit_m, up=up, where=str(path))
    return Take(names, parents, metres, rate_hz, trial=path.stem, notes=(*notes, *found))


def bvh_positions(file: BvhFile) -> tuple[tuple[str, ...], tuple[int, ...], np.ndarray]:
    """Names and parents of joints and End Sites with length, and their places (T, J, 3) in the unit of the file."""
    from emulator.kernels.hierarchy import walk

    kept = np.flatnonzero(np.any(file.end_offsets != 0, axis=1))
    names = [*file.names, *_end_names(file, kept)]
    parents = np.array([*file.parents, *(file.end_parents[e] for e in kept)], np.int64)
    offsets = np.concatenate([file.offsets, file.end_offsets[kept]])
    kind = np.array([CHANNELS.index(channel) for channels in file.channels for channel in channels], np.int64)
    n_channels = [*map(len, file.channels), *(0 for _ in kept)]
    joints = np.empty((len(file.values), len(names), 3))
    walk(
        file.values,
        np.arange(len(names)),
        parents,
        np.cumsum([0, *n_channels]),
        np.arange(len(kind)),
        kind,
        offsets,
        np.empty((0, 3, 3)),
        False,
        joints,
    )
    return tuple(names), tuple(parents.tolist()), joints


def rate_of(frame_time_s: float) -> float:
    """Frames a second: 30 for 0.0333333, 30000/1001 for 0.0333667; what no usual rate rounds to is taken as it is."""
    word = f"{frame_time_s:.17g}"
    digits = len(repr(frame_time_s).partition(".")[2]) if "e" not in repr(frame_time_s) else len(word)
    exact = 1.0 / frame_time_s
    for usual in (float(round(exact)), round(exact * 1.001) / 1.001):
        if usual > 0 and abs(1.0 / usual - frame_time_s) <= 0.5000001 * 10.0**-digits:
            return usual
    return exact


def _end_names(file: BvhFile, kept: np.ndarray) -> list[str]:
    taken = set(file.names)
    names = []
    for end in kept:
        plain = name = f"{file.names[file.end_parents[end]]}_end"
        count = 1
        while name in taken:
            count += 1
            name = f"{plain}{count}"
        taken.add(name)
        names.append(name)
    return names


def _notes(file: BvhFile, names: tuple[str, ...]) -> list[str]:
    notes = []
    if dropped := len(file.names) + len(file.end_parents) - len(names):
        notes.append(f"{dropped} End Site{'s' * (dropped > 1)} without length dropped")
    moved = [
        name
        for name, parent, channels in zip(file.names, file.parents, file.channels)
        if parent >= 0 and any(channel.endswith("position") for channel in channels)
    ]
    if moved:
        notes.append(f"{len(moved)} joints below the root have position channels, which replace their OFFSET")
    if np.any(file.offsets[0] != 0) and any(channel.endswith("position") for channel in file.channels[0]):
        notes.append("the root has an OFFSET and position channels; the channels replace it")
    if abs(file.rate_hz * file.frame_time_s - 1) > WHOLE_RATE:
        notes.append(f"frame time {file.frame_time_s:g} s read as {file.rate_hz:g} frames a second")
    return notes
