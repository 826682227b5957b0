r"""Text of any encoding in bounded memory: blocks of UTF-8 bytes whose lines end in ``\n``, or numbered lines.

A text file of numbers under header lines: cells by commas, semicolons, tabs or blanks; empty cells are nan.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain, islice
from pathlib import Path

import numpy as np


class RecordingError(ValueError):
    """A recording that cannot be read: the message names the file, what was found and what was expected."""


BLOCK_BYTES = 1 << 20
MOST_LINE_BYTES = 1 << 20
"""A longer line is a damaged or hostile file: a frame of 10,000 channels has a tenth of that."""
MOST_TIMES_LARGER = 16
"""Joints take at most so many times the bytes of their file, besides the first 64 MB: a digit and a blank are 2."""
MOST_PLACES = 5
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
        f"found {quoted(name)} {len(found)} times, as {what} {_first(found)}; {remedy}"
        for name, found in at.items()
        if len(found) > 1
    ]


def _first(places: Sequence[object]) -> str:
    """All of a few places, of many the first."""
    if len(places) <= MOST_PLACES:
        return " and ".join(map(str, places))
    return f"{', '.join(map(str, places[:MOST_PLACES]))} and {len(places) - MOST_PLACES} more"


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


MOST_HEADER_LINES = 60
MOST_COLUMNS = 20_000
MOST_SAID = 10
_TIME_OF_DAY = re.compile(r"^\d{1,2}:\d{2}:\d{2}\b")
"""A time code beside the numbers is no number and no mistake."""
_EMPTY = {"", "nan", "null", "none", "na", "n/a", "-", "#n/a", "missing"}


@dataclass(frozen=True)
class Table:
    """``header`` rows of cells, ``header_line`` their line numbers; ``values`` (R, C); ``line`` (R,) of each row."""

    header: tuple[tuple[str, ...], ...]
    header_line: tuple[int, ...]
    values: np.ndarray
    line: np.ndarray


def read_table(path: Path, *, delimiter: str | None = None, first_row: int = 0, short_rows: bool = False) -> Table:
    """The table of a file. Raises RecordingError with the first wrong lines: text among numbers, rows cut short.

    delimiter  : the sign between cells; None finds it
    first_row  : the line of the first row of numbers, where the format says it; 0 finds it
    short_rows : whether empty cells at the end of a row may be left out
    """
    lines = text_lines(path)
    first = [(n, text) for n, text in islice(lines, MOST_HEADER_LINES) if text.strip()]
    sign = delimiter or _delimiter([text for _, text in first])
    cells = [(n, cells_of(text, sign)) for n, text in first]
    start = next((i for i, (n, _) in enumerate(cells) if n >= first_row and _is_row(cells, i)), None)
    if start is None:
        raise RecordingError(f"{path}: found no row of numbers in the first {MOST_HEADER_LINES} lines")
    header = cells[:start]
    width = max(len(row) for _, row in cells[max(0, start - 3) : start + 1]) if short_rows else len(cells[start][1])
    if width > MOST_COLUMNS:
        raise RecordingError(f"{path}:{cells[start][0]}: found {width} columns, expected {MOST_COLUMNS} at most")
    rows = _Rows(path, sign, width, short_rows)
    rows.read(chain(first[start:], lines))
    return Table(
        tuple(tuple(row) for _, row in header),
        tuple(n for n, _ in header),
        np.array(rows.values, float).reshape(len(rows.line), width),
        np.array(rows.line),
    )


@dataclass
class _Rows:
    path: Path
    sign: str | None
    width: int
    short_rows: bool
    values: array[float] = field(default_factory=lambda: array("d"))
    line: list[int] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)

    def read(self, lines: Iterable[tuple[int, str]]) -> None:
        """All rows. Raises RecordingError with the first wrong ones."""
        for number, text in lines:
            if text.strip():
                self._add(number, text)
            if len(self.wrong) >= MOST_SAID:
                self.wrong.append(f"{self.path}: the lines after {number} were not looked at")
                break
        if self.wrong:
            raise RecordingError("\n".join(self.wrong))

    def _add(self, number: int, text: str) -> None:
        cells = cells_of(text, self.sign)
        quick = _quickly(text, cells, self.sign) if len(cells) == self.width else None
        if quick is not None:
            self.values.extend(quick)
            self.line.append(number)
            return
        if self.short_rows:
            cells += [""] * (self.width - len(cells))
        if len(cells) < self.width or any(cells[self.width :]):
            self.wrong.append(f"{self.path}:{number}: found {len(cells)} values, expected {self.width}")
            return
        values = [number_of(cell, self.sign) for cell in cells[: self.width]]
        numbers = [value for value in values if value is not None]
        if len(numbers) < len(values):
            column = values.index(None)
            found = quoted(cells[column])
            self.wrong.append(f"{self.path}:{number}: column {column + 1}: found {found}, expected a number or nothing")
            return
        self.values.extend(numbers)
        self.line.append(number)


def _quickly(text: str, cells: list[str], sign: str | None) -> list[float] | None:
    """A row of nothing but numbers in range; None for any other, which is looked at cell by cell (a third as fast)."""
    if "_" in text or (sign == ";" and "," in text):
        return None
    try:
        values = list(map(float, cells))
    except ValueError:
        return None
    return values if max(values) < 1e30 and min(values) > -1e30 else None


def number_of(cell: str, sign: str | None = None) -> float | None:
    """The number, nan for an empty cell, None for text and for what is no finite number."""
    if cell.lower() in _EMPTY or _TIME_OF_DAY.match(cell):
        return float("nan")
    try:
        value = float(cell.replace(",", ".") if sign == ";" else cell)
    except ValueError:
        return None
    return value if abs(value) < 1e30 and "_" not in cell else None


def cells_of(text: str, sign: str | None) -> list[str]:
    """The cells of a line; quotation marks hold a cell together."""
    if sign is None:
        return text.split()
    if '"' in text:
        try:
            return [cell.strip() for cell in next(csv.reader([text], delimiter=sign))]
        except (csv.Error, StopIteration):
            pass
    return [cell.strip() for cell in text.split(sign)]


def _is_row(cells: list[tuple[int, list[str]]], i: int) -> bool:
    """A row of numbers, and not one of few among the words of a header, such as a frame rate."""
    row, after = cells[i][1], [other for _, other in cells[i + 1 : i + 3]]
    if not _numeric(row):  # a row with a wrong cell, right before the others, is one of them
        numbers = sum(number_of(cell, ";") is not None for cell in row if cell)
        return numbers > max(3, 0.8 * sum(map(bool, row))) and bool(after) and _numeric(after[0])
    given = sum(map(bool, row))
    return not after or _numeric(after[0]) or given >= max(sum(map(bool, other)) for other in after) > 1


def _numeric(cells: list[str]) -> bool:
    numbers = [number_of(cell, ";") for cell in cells]
    return None not in numbers and any(value == value for value in numbers)


def _delimiter(lines: list[str]) -> str | None:
    """The sign between the cells of the last of these lines; None is blanks."""
    last = lines[-3:]
    for sign in ("\t", ";", ","):
        if last and all(sign in line for line in last):
            return sign
    return next((sign for sign in ("\t", ";", ",") if last and sign in last[-1]), None)
