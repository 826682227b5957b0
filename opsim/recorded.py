"""Recorded durations: a column of a CSV file, in seconds."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from opsim.clock import LONGEST_S
from opsim.files import NotInside, inside
from opsim.problems import did_you_mean, shown

MOST_BYTES = 50_000_000


class RecordedError(ValueError):
    """Recorded times that cannot be used: ``message`` and ``hint`` in plain words."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message, self.hint = message, hint


def resolve_times(name: str, folder: Path) -> Path:
    """The CSV file in the scenario's folder. Raises RecordedError."""
    try:
        found = inside(name, folder)
    except NotInside as error:
        raise RecordedError(f"cannot use {shown(name)}: {error}", "copy the file there") from None
    if found is None:
        hint = did_you_mean(name, [path.name for path in folder.glob("*.csv")], otherwise="files there")
        raise RecordedError(f"no file {shown(name)} in the scenario's folder", hint)
    return found


def read_times(path: Path, column: str | None = None) -> list[float]:
    """The positive durations in seconds of a column, in the file's order.

    The first row is a heading unless all of it is numbers. ``column`` may be left out where there is one only.
    Raises RecordedError with the line of the first bad number.
    """
    names, rows = _table(path)
    index = _column(names, column, path.name)
    times = [_positive(cells, index, line, path.name) for line, cells in rows]
    if not times:
        raise RecordedError(f"{shown(path.name)} holds no times")
    return times


def column_names(path: Path) -> tuple[str, ...]:
    """The heading of a CSV file, empty where it has none. Raises RecordedError where it cannot be read."""
    return tuple(_table(path)[0] or ())


def read_labels(path: Path, column: str) -> list[str]:
    """The words of a column, in the file's order: one a row of ``read_times``. Raises RecordedError."""
    names, rows = _table(path)
    index = _column(names, column, path.name)
    return [cells[index].strip() if index < len(cells) else "" for _, cells in rows]


def _table(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The names of the columns, and the rows below them with their line numbers."""
    rows = rows_of(path)
    heading = [cell.strip() for cell in rows[0][1]]
    if all(_number(cell) is not None for cell in heading):
        return [str(number + 1) for number in range(len(heading))], rows
    return heading, rows[1:]


def rows_of(path: Path) -> list[tuple[int, list[str]]]:
    """The rows of a CSV file that are not blank, each with its line number from 1. Raises RecordedError."""
    if path.stat().st_size > MOST_BYTES:
        raise RecordedError(f"{shown(path.name)} is larger than {MOST_BYTES / 1e6:.0f} MB")
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError):
        raise RecordedError(f"{shown(path.name)} cannot be read as text") from None
    first = text.partition("\n")[0]
    delimiter = next((mark for mark in (",", ";", "\t") if mark in first), ",")
    try:
        reader = csv.reader(text.splitlines(), delimiter=delimiter)
        rows = [(reader.line_num, cells) for cells in reader if any(cell.strip() for cell in cells)]
    except csv.Error as error:
        raise RecordedError(f"{shown(path.name)} is not a CSV file: {error}") from None
    if not rows:
        raise RecordedError(f"{shown(path.name)} is empty", "fill it, or name another file")
    return rows


def _column(names: list[str], column: str | None, file: str) -> int:
    if column is None and len(names) > 1:
        raise RecordedError(
            f"{shown(file)} has {len(names)} columns", f"add 'column:' with one of: {', '.join(names[:8])}"
        )
    if column is None:
        return 0
    if column not in names:
        raise RecordedError(
            f"no column {shown(column)} in {shown(file)}", did_you_mean(column, names, otherwise="columns")
        )
    return names.index(column)


def _positive(cells: list[str], index: int, line: int, file: str) -> float:
    cell = cells[index] if index < len(cells) else ""
    number = _number(cell)
    if number is None or not number > 0 or not math.isfinite(number):
        raise RecordedError(f"{shown(file)} line {line}: {shown(cell)} is not a positive number of seconds")
    if number > LONGEST_S:
        raise RecordedError(f"{shown(file)} line {line}: {shown(cell)} is more than 2^33 s (272 years)")
    return number


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None
