"""Recorded durations: a column of a CSV file, in seconds.

Lists of orders and sequences of products: CSV files with a heading, every mistake told with its line.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.clock import LONGEST_S, TICKS_PER_S
from opsim.files import NotInside, inside
from opsim.problems import MOST_SHOWN, did_you_mean, shown

MOST_BYTES = 50_000_000
_ONE_EACH = "write decimals with a point, and text that holds a comma in quotes"


class RecordedError(ValueError):
    """Recorded times that cannot be used: ``message`` and ``hint`` in plain words."""

    def __init__(self, message: str, hint: str = ""):
        super().__init__(f"{message}; {hint}" if hint else message)
        self.message, self.hint = message, hint


@dataclass(frozen=True, slots=True)
class Mistake:
    """What is wrong with a row. line : counted from 1; cell : which one of the row, counted from 0"""

    line: int
    cell: int
    message: str
    hint: str = ""


class WrongRows(RecordedError):
    """Rows that cannot be used: ``mistakes`` says what is wrong with each."""

    def __init__(self, file: str, mistakes: list[Mistake]):
        said = [
            f"{shown(file)} line {one.line}: {'; '.join(filter(None, (one.message, one.hint)))}" for one in mistakes
        ]
        more = len(said) - MOST_SHOWN
        super().__init__("\n".join([*said[:MOST_SHOWN], *([f"and {more} more"] if more > 0 else [])]))
        self.mistakes = mistakes


def resolve_times(name: str, folder: Path) -> Path:
    """The CSV file in the scenario's folder. Raises RecordedError."""
    try:
        found = inside(name, folder)
    except NotInside as error:
        raise RecordedError(f"cannot use {shown(name)}: {error}", "copy the file there") from None
    if found is None:
        hint = did_you_mean(name, [path.name for path in folder.glob("*.csv")], otherwise="files there", files=True)
        raise RecordedError(f"no file {shown(name)} in the scenario's folder", hint)
    return found


def read_times(path: Path, column: str | None = None, key: str = "column:") -> list[float]:
    """The positive durations in seconds of a column, in the file's order.

    The first row is a heading unless all of it is numbers. ``column`` may be left out where there is one only;
    ``key`` is where the user says it.
    Raises RecordedError, WrongRows where it is the rows that are wrong.
    """
    names, rows = _table(path)
    if column is None and len(names) > 1:
        found = f"{shown(path.name)} has {len(names)} columns"
        raise RecordedError(found, f"add '{key}' with one of: {', '.join(names[:8])}")
    index = 0 if column is None else _column(names, column, path.name)
    if not rows:
        raise RecordedError(f"{shown(path.name)} holds no times")
    mistakes = _surplus(names, rows)
    times_s = [_positive_s(cells, index, line, mistakes) for line, cells in rows]
    if mistakes:
        raise WrongRows(path.name, sorted(mistakes, key=lambda one: (one.line, one.cell)))
    return times_s


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


def _column(names: list[str], column: str, file: str) -> int:
    if column not in names:
        raise RecordedError(
            f"no column {shown(column)} in {shown(file)}", did_you_mean(column, names, otherwise="columns")
        )
    return names.index(column)


def _surplus(names: list[str], rows: list[tuple[int, list[str]]]) -> list[Mistake]:
    """Rows with more values than the first line has columns; blank cells at their end are none."""
    n_values = [(line, max(at + 1 for at, cell in enumerate(cells) if cell.strip())) for line, cells in rows]
    found = [(line, n) for line, n in n_values if n > len(names)]
    return [Mistake(line, len(names), f"{n} values, the first line has {len(names)}", _ONE_EACH) for line, n in found]


def _positive_s(cells: list[str], index: int, line: int, mistakes: list[Mistake]) -> float:
    """The time in a cell; what is wrong with it is added to ``mistakes``."""
    cell = cells[index] if index < len(cells) else ""
    number = _number(cell)
    if number is None or not number > 0 or not math.isfinite(number):
        mistakes.append(Mistake(line, index, f"{shown(cell)} is not a positive number of seconds"))
    elif number > LONGEST_S:
        mistakes.append(Mistake(line, index, f"{shown(cell)} is more than 2^33 s (272 years)"))
    return number or 0.0


def _number(cell: str) -> float | None:
    try:
        return float(cell)
    except ValueError:
        return None


MOST_OF_AN_ORDER = 100_000
MOST_JOBS = 10_000_000
MOST_PRIORITY = 1_000_000
_TIME = ("a time in seconds or as h:mm:ss", "from 0 on, such as 90 or 0:01:30")
_NUMBER = (f"a whole number from 1 to {MOST_OF_AN_ORDER:,}", "such as 1")
_PRIORITY = ("a whole number", "such as 2")
_PRODUCT = ("", "")
_IN_TIME = "put the lines in the order of their times"
_FEWER = "remove lines, or write smaller quantities"
_CLOCK = re.compile(r"([0-9]{1,7}):([0-5][0-9])(?::([0-5][0-9](?:\.[0-9]+)?))?")


@dataclass(frozen=True, slots=True)
class Order:
    """So many jobs of a product at a time, in seconds on the engine's grid.

    product : None where the file does not say; due_s : inf, priority : None where the product's own stands
    """

    time_s: float
    product: str | None
    quantity: int = 1
    due_s: float = math.inf
    priority: int | None = None


def read_orders(path: Path, products: Collection[str]) -> tuple[list[Order], list[Mistake]]:
    """The orders of a file, and its mistakes, of which one is that times go backwards.

    Columns, in any order: time (seconds, or h:mm or h:mm:ss since the start), and where wanted product, quantity, due
    and priority. Raises RecordedError where there is no table.
    """
    names, rows, mistakes = _order_table(path, ("time",), ("product", "quantity", "due", "priority"))
    orders: list[Order] = []
    for line, row in rows:
        read = _Row(row, line, mistakes)
        time_s = read.cell("time", _time_s, _TIME)
        if time_s is not None and orders and time_s < orders[-1].time_s:
            read.wrong("time", f"time {shown(row['time'])} is before that of the order above", _IN_TIME)
        product = read.cell("product", lambda cell: _known(cell, products), _PRODUCT) if "product" in names else None
        quantity = read.cell("quantity", _quantity, _NUMBER, 1)
        due_s = read.cell("due", _time_s, _TIME, math.inf)
        priority = read.cell("priority", _priority, _PRIORITY, None)
        orders.append(Order(time_s or 0.0, product, quantity or 1, math.inf if due_s is None else due_s, priority))
    if sum(order.quantity for order in orders) > MOST_JOBS:
        mistakes.append(Mistake(rows[-1][0], 0, f"up to here more than {MOST_JOBS:,} jobs are ordered", _FEWER))
    return orders, mistakes


def read_sequence(path: Path, products: Collection[str]) -> tuple[list[str], list[Mistake]]:
    """The products of a file in its order, each as often as its quantity says, and the file's mistakes.

    Columns: product, and where wanted quantity. Raises RecordedError where there is no table.
    """
    _, rows, mistakes = _order_table(path, ("product",), ("quantity",))
    sequence: list[str] = []
    for line, row in rows:
        read = _Row(row, line, mistakes)
        product = read.cell("product", lambda cell: _known(cell, products), _PRODUCT)
        quantity = read.cell("quantity", _quantity, _NUMBER, 1)
        if len(sequence) + (quantity or 1) > MOST_JOBS:
            return sequence, [*mistakes, Mistake(line, 0, f"up to here there are more than {MOST_JOBS:,} jobs", _FEWER)]
        sequence += [product or ""] * (quantity or 1)
    return sequence, mistakes


Table = tuple[list[str], list[tuple[int, dict[str, str]]], list[Mistake]]


def _order_table(path: Path, needed: tuple[str, ...], wanted: tuple[str, ...]) -> Table:
    """The columns of a file, its rows by column, each with its line, and rows too long. Raises RecordedError."""
    (_, heading), *rows = rows_of(path)
    names = [cell.strip().casefold() for cell in heading]
    known, where = (*needed, *wanted), shown(path.name)
    missing = next((name for name in needed if name not in names), None)
    if missing is not None:
        hint = f"its first line must name the columns: {', '.join(known)}"
        raise RecordedError(f"{where} has no column {shown(missing)}", hint)
    for name in names:
        if name not in known:
            raise RecordedError(f"{where} has a column {shown(name)}", did_you_mean(name, known, otherwise="columns"))
        if names.count(name) > 1:
            raise RecordedError(f"{where} has two columns {shown(name)}", "keep one of them")
    if not rows:
        raise RecordedError(f"{where} has no rows below its heading", "add a line for each order or product")
    by_column = [(line, dict(zip(names, (cell.strip() for cell in cells)))) for line, cells in rows]
    return names, by_column, _surplus(names, rows)


class _NoValue(ValueError):
    """A cell that cannot be read; what it says is the hint."""


@dataclass(frozen=True, slots=True)
class _Row:
    """One row being read; what is wrong with its cells is added to ``mistakes``."""

    cells: dict[str, str]
    line: int
    mistakes: list[Mistake]

    def wrong(self, name: str, message: str, hint: str) -> None:
        """One more mistake, in the cell of this name."""
        number = list(self.cells).index(name) if name in self.cells else 0
        self.mistakes.append(Mistake(self.line, number, message, hint))

    def cell(self, name: str, read: Callable[[str], Any], expected: tuple[str, str], otherwise: Any = ...) -> Any:
        """The value of a cell; ``otherwise`` where it is empty and may be, None where it is wrong.

        expected : what it should be, and an example; of a product, whose readers know better, neither
        """
        text = self.cells.get(name, "")
        if not text and otherwise is not ...:
            return otherwise
        try:
            return read(text)
        except ValueError as error:
            what, example = expected
            if not text:
                self.wrong(name, f"there is no {name}", "fill the cell, or remove the line")
            elif isinstance(error, _NoValue):
                self.wrong(name, f"no {name} {shown(text)}", str(error))
            else:
                self.wrong(name, f"{name} {shown(text)} is not {what}", example)
            return None


def _known(cell: str, products: Collection[str]) -> str:
    if cell not in products:
        raise _NoValue(did_you_mean(cell, products, otherwise="products"))
    return cell


def _time_s(cell: str) -> float:
    """Seconds on the engine's grid, from 0."""
    clock = _CLOCK.fullmatch(cell)
    time_s = float(cell) if clock is None else 3600 * int(clock[1]) + 60 * int(clock[2]) + float(clock[3] or 0)
    if not 0 <= time_s <= LONGEST_S:
        raise ValueError
    return round(time_s * TICKS_PER_S) / TICKS_PER_S


def _quantity(cell: str) -> int:
    number = int(cell)
    if not 1 <= number <= MOST_OF_AN_ORDER:
        raise ValueError
    return number


def _priority(cell: str) -> int:
    number = int(cell)
    if abs(number) > MOST_PRIORITY:
        raise ValueError
    return number
