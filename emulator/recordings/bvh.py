"""The MOTION of a BVH file: a stream of blocks becomes one array, with no more memory than that and one block.

BVH: a hierarchy of joints, and for each frame the values of their channels.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from emulator.recordings.bvh_header import CHANNELS, MOST_WORDS, HierarchyReader, words_of
from emulator.recordings.take import Take
from emulator.recordings.text import BLOCK_BYTES, RecordingError, decoded, finite, quoted, refuse_swelling, text_blocks

MOST_HEADER_BYTES = 8 << 20
MOST_WORD_BYTES = 1000
SLOWEST_S, FASTEST_S = 10.0, 1e-5
"""Seconds a frame that a recording can have."""
_END_OF_HEADER = re.compile(rb"(?i)^[ \t]*frame[ \t]*time[ \t]*:[^\n]*(\n|\Z)", re.MULTILINE)
_MOTION = re.compile(r"(?im)^[ \t]*motion[ \t]*$")
_FRAMES = re.compile(r"(?i)^[ \t]*frames[ \t]*:(.*)$")
_FRAME_TIME = re.compile(r"(?i)^[ \t]*frame[ \t]*time[ \t]*:(.*)$")
_ODD_AT_ONCE = 4096


@dataclass(frozen=True)
class Head:
    """What stands before the frames: text of the hierarchy, number of frames and its line, seconds a frame as text."""

    hierarchy: str
    n_frames: int
    frames_line: int
    frame_time: str
    n_lines: int

    @property
    def frame_time_s(self) -> float:
        return float(self.frame_time)


def opened(path: Path, block_bytes: int = BLOCK_BYTES) -> tuple[Head, Iterator[bytes]]:
    """The head of a BVH file, and blocks of bytes from its first frame on. Raises RecordingError."""
    blocks = text_blocks(path, block_bytes)
    text = b""
    for block in blocks:
        text += block
        found = _END_OF_HEADER.search(text)
        if found and (found.end() < len(text) or text.endswith(b"\n")):
            break
        if len(text) > MOST_HEADER_BYTES:
            raise RecordingError(f"{path}: found no 'Frame Time:' in {MOST_HEADER_BYTES >> 20} MB, expected a BVH file")
    found = _END_OF_HEADER.search(text)
    end = found.end() if found else len(text)
    return _head(path, decoded(text[:end]), bool(found)), _after(text[end:], blocks)


def _after(rest: bytes, blocks: Iterator[bytes]) -> Iterator[bytes]:
    yield rest
    yield from blocks


def _head(path: Path, text: str, has_time: bool) -> Head:
    motion = _MOTION.search(text)
    if motion is None:
        what = "MOTION on a line of its own" if text.strip() else "HIERARCHY and MOTION; the file is empty"
        raise RecordingError(f"{path}:{_line(text)}: found no MOTION, expected {what}")
    line = text.count("\n", 0, motion.end()) + 1
    frames = frame_time = ""
    frames_line = line
    for number, said in enumerate(text[motion.end() :].split("\n")[1:], line + 1):
        if match := _FRAMES.match(said):
            frames, frames_line = match.group(1).strip(), number
        elif match := _FRAME_TIME.match(said):
            frame_time = match.group(1).strip()
            _checked_time(path, number, frame_time)
        elif said.strip():
            raise RecordingError(f"{path}:{number}: found {quoted(said.strip())}, expected 'Frames:' or 'Frame Time:'")
    if not frames or not has_time:
        missing = "'Frames:'" if not frames else "'Frame Time:'"
        raise RecordingError(f"{path}:{_line(text)}: found no {missing} after MOTION, expected one")
    if not (frames.isascii() and frames.isdigit() and len(frames) < 19 and int(frames) > 0):
        raise RecordingError(f"{path}:{frames_line}: found {quoted(frames)} frames, expected a whole number from 1")
    return Head(text[: motion.start()], int(frames), frames_line, frame_time, text.count("\n"))


def _line(text: str) -> int:
    return text.rstrip().count("\n") + 1


def _checked_time(path: Path, line: int, word: str) -> None:
    value = finite(word)
    if value is None or not FASTEST_S <= value <= SLOWEST_S:
        raise RecordingError(
            f"{path}:{line}: found frame time {quoted(word)}, expected {FASTEST_S:g} to {SLOWEST_S:g} seconds"
        )


def read_values(path: Path, head: Head, blocks: Iterator[bytes], columns: int) -> np.ndarray:
    """The frames, (T, C). Raises RecordingError with the line of the first mistake.

    Nothing is allocated for frames that the file is too short to hold: a value takes two bytes or more.
    """
    most = (path.stat().st_size + 1) // (2 * columns)
    if head.n_frames > most:
        raise RecordingError(
            f"{path}:{head.frames_line}: found {head.n_frames:,} frames of {columns} values declared, "
            f"expected at most {most:,} in a file of {path.stat().st_size:,} bytes"
        )
    return _Frames(path, head, columns).read(blocks)


class _Frames:
    """The values so far, and where in the text they end."""

    def __init__(self, path: Path, head: Head, columns: int) -> None:
        self.path, self.head, self.columns = path, head, columns
        self.values = np.empty(head.n_frames * columns)
        self.state = np.zeros(5, np.int64)
        self.state[0] = head.n_lines + 1
        self.odd = np.empty((_ODD_AT_ONCE, 4), np.int64)

    def read(self, blocks: Iterator[bytes]) -> np.ndarray:
        rest = b""
        for block in blocks:
            text = rest + block if rest else block
            end = max(text.rfind(b" "), text.rfind(b"\n"), text.rfind(b"\t")) + 1
            rest = text[end:]
            if len(rest) > MOST_WORD_BYTES:
                line = self.state[0] + text.count(b"\n", 0, end)
                self._stop(int(line), f"found {quoted(decoded(rest[:100]))}, expected a number")
            self._take(memoryview(text)[:end])
        self._take(memoryview(rest + b"\n"))
        done = int(self.state[2]) // self.columns
        if done < self.head.n_frames:
            where = f"line {self.head.frames_line} declares"
            self._stop(int(self.state[0]) - 1, f"found the end after {done:,} frames, {where} {self.head.n_frames:,}")
        return self.values.reshape(self.head.n_frames, self.columns)

    def _take(self, text: memoryview) -> None:
        """One piece of text, from a word's start to a word's end."""
        from emulator.kernels.text import AT, FULL, N_ODD, READ, read_numbers

        content = np.frombuffer(text, np.uint8)
        self.state[AT] = 0
        stopped = FULL
        while stopped == FULL:
            self.state[N_ODD] = 0
            stopped = read_numbers(content, self.columns, self.values, self.state, self.odd)
            for start, stop, place, line in self.odd[: self.state[N_ODD]].tolist():
                self.values[place] = self._slowly(decoded(bytes(text[start:stop])), line)
        if stopped != READ:
            self._refuse(int(stopped))

    def _slowly(self, word: str, line: int) -> float:
        value = finite(word) if len(word) <= MOST_WORD_BYTES else None
        if value is None:
            comma = finite(word.replace(",", ".", 1)) is not None
            self._stop(line, f"found {quoted(word)}, expected a {'decimal point' if comma else 'number'}")
        return float(value or 0.0)

    def _refuse(self, stopped: int) -> None:
        from emulator.kernels.text import IN_LINE, LINE, TOO_FEW

        line, found = int(self.state[LINE]), int(self.state[IN_LINE])
        if stopped == TOO_FEW:
            self._stop(line, f"found {found} values, expected {self.columns}, one for each channel")
        if found == self.columns:
            self._stop(line, f"found more than {found} values, expected {found}, one for each channel")
        declared = f"{self.head.n_frames:,} as line {self.head.frames_line} says"
        self._stop(line, f"found another frame, expected {declared}")

    def _stop(self, line: int, what: str) -> None:
        raise RecordingError(f"{self.path}:{line}: {what}")


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
    from emulator.recordings.orientation import placed

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
    from emulator.kernels.bodies import walk

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
