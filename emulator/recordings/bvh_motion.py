"""The MOTION of a BVH file: a stream of blocks becomes one array, with no more memory than that and one block."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.text import BLOCK_BYTES, decoded, finite, quoted, text_blocks

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
        from emulator.kernels.numbers import AT, FULL, N_ODD, READ, read_numbers

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
        from emulator.kernels.numbers import IN_LINE, LINE, TOO_FEW

        line, found = int(self.state[LINE]), int(self.state[IN_LINE])
        if stopped == TOO_FEW:
            self._stop(line, f"found {found} values, expected {self.columns}, one for each channel")
        if found == self.columns:
            self._stop(line, f"found more than {found} values, expected {found}, one for each channel")
        declared = f"{self.head.n_frames:,} as line {self.head.frames_line} says"
        self._stop(line, f"found another frame, expected {declared}")

    def _stop(self, line: int, what: str) -> None:
        raise RecordingError(f"{self.path}:{line}: {what}")
