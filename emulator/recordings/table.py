"""A text file of numbers under header lines: cells by commas, semicolons, tabs or blanks; empty cells are nan."""

from __future__ import annotations

import csv
import re
from array import array
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain, islice
from pathlib import Path

import numpy as np

from emulator.recordings import RecordingError
from emulator.recordings.text import quoted, text_lines

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
