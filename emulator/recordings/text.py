"""Text of any encoding in bounded memory: blocks of UTF-8 bytes whose lines end in ``\\n``, or numbered lines."""

from __future__ import annotations

import codecs
import math
from collections.abc import Iterator, Sequence
from pathlib import Path

from emulator.recordings import RecordingError

BLOCK_BYTES = 1 << 20
MOST_LINE_BYTES = 1 << 20
"""A longer line is a damaged or hostile file: a frame of 10,000 channels has a tenth of that."""
MOST_TIMES_LARGER = 16
"""Joints take at most so many times the bytes of their file, besides the first 64 MB: a digit and a blank are 2."""
_MARKS = (
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
    (codecs.BOM_UTF8, "utf-8-sig"),
)


def text_blocks(path: Path, block_bytes: int = BLOCK_BYTES) -> Iterator[bytes]:
    """The file in blocks: byte order marks gone, UTF-16 and UTF-32 made UTF-8, other bytes as they are (``decoded``).

    Raises RecordingError where there is no such file, or its UTF-16 is damaged.
    """
    if not path.is_file():
        raise RecordingError(f"{path}: {'is no file' if path.exists() else 'no such file'}")
    with path.open("rb") as file:
        first = file.read(block_bytes)
        encoding = _encoding(first)
        decoder = None if encoding is None else codecs.getincrementaldecoder(encoding)()
        waiting = b""
        block = first
        while block:
            following = file.read(block_bytes)
            text = block if decoder is None else _recoded(path, decoder, block, final=not following)
            text = waiting + text
            waiting = b"\r" if text.endswith(b"\r") and following else b""
            yield _with_plain_ends(text[:-1] if waiting else text)
            block = following


def text_lines(path: Path) -> Iterator[tuple[int, str]]:
    """(line number from 1, line without its end). Raises RecordingError for a line of more than a megabyte."""
    number, rest = 0, b""
    for block in text_blocks(path):
        *lines, rest = (rest + block).split(b"\n")
        for line in lines:
            number += 1
            yield number, decoded(_short(path, number, line))
        _short(path, number + 1, rest)
    if rest:
        yield number + 1, decoded(rest)


def refuse_swelling(path: Path, n_frames: int, n_joints: int) -> None:
    """Raises RecordingError where joints (T, J, 3) would take far more memory than the file that tells of them."""
    expected = MOST_TIMES_LARGER * path.stat().st_size + (64 << 20)
    if 24 * n_frames * n_joints > expected:
        raise RecordingError(
            f"{path}: found {n_frames:,} frames of {n_joints:,} joints in {path.stat().st_size / 2**20:.1f} MB, "
            "expected numbers for more of them"
        )


def decoded(text: bytes) -> str:
    """UTF-8, or Latin-1 where it is not."""
    try:
        return text.decode("utf-8")
    except UnicodeDecodeError:
        return text.decode("latin-1")


def quoted(text: str, most: int = 40) -> str:
    """A piece of a file in a message: one line, at most ``most`` characters."""
    return repr(text if len(text) <= most else text[: most - 3] + "...")


def said_twice(names: Sequence[str], what: str, places: Sequence[object], remedy: str) -> list[str]:
    """A message for each of the names that is there more than once, with its places; empty where none is.

    what : the kind of place, such as "column"; remedy : what to do about it
    """
    at: dict[str, list[object]] = {}
    for name, place in zip(names, places):
        at.setdefault(name, []).append(place)
    return [
        f"found {quoted(name)} {len(found)} times, as {what} {' and '.join(map(str, found))}; {remedy}"
        for name, found in at.items()
        if len(found) > 1
    ]


def finite(word: str) -> float | None:
    """The number that a word says in plain digits, or None: no nan, inf, underscores."""
    try:
        value = float(word)
    except ValueError:
        return None
    return value if math.isfinite(value) and "_" not in word and word.isascii() else None


def _encoding(first: bytes) -> str | None:
    marked = next((encoding for mark, encoding in _MARKS if first.startswith(mark)), None)
    if marked is None and len(first) >= 4 and first[1] == 0 == first[3] and first[0] and first[2]:
        return "utf-16-le"
    if marked is None and len(first) >= 4 and first[0] == 0 == first[2] and first[1] and first[3]:
        return "utf-16-be"
    return marked


def _recoded(path: Path, decoder: codecs.IncrementalDecoder, block: bytes, final: bool) -> bytes:
    try:
        return decoder.decode(block, final).encode("utf-8")
    except UnicodeError as error:
        raise RecordingError(f"{path}: damaged text ({error})") from None


def _with_plain_ends(text: bytes) -> bytes:
    return text.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in text else text


def _short(path: Path, number: int, line: bytes) -> bytes:
    if len(line) > MOST_LINE_BYTES:
        raise RecordingError(f"{path}:{number}: found a line of more than {MOST_LINE_BYTES >> 20} MB, expected text")
    return line
