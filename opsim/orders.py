"""Lists of orders and sequences of products: CSV files with a heading, every mistake told with its line."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from opsim.clock import LONGEST_S, TICKS_PER_S
from opsim.problems import did_you_mean, shown
from opsim.recorded import RecordedError, rows_of

MOST_OF_AN_ORDER = 100_000
MOST_JOBS = 10_000_000
MOST_PRIORITY = 1_000_000
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


def read_orders(path: Path, products: Collection[str]) -> tuple[list[Order], list[str]]:
    """The orders of a file by time (those of one time in the file's order), and its mistakes, a sentence each.

    Columns, in any order: time (seconds, or h:mm or h:mm:ss since the start), and where wanted product, quantity, due
    and priority. Raises RecordedError where there is no table.
    """
    names, rows = _table(path, ("time",), ("product", "quantity", "due", "priority"))
    mistakes: list[str] = []
    orders = []
    for line, row in rows:
        read = _Row(row, f"{shown(path.name)} line {line}", mistakes)
        time_s = read.cell("time", _time_s, "a time in seconds or as h:mm:ss")
        product = read.cell("product", lambda cell: _known(cell, products), "") if "product" in names else None
        quantity = read.cell("quantity", _quantity, f"a whole number from 1 to {MOST_OF_AN_ORDER:,}", 1)
        due_s = read.cell("due", _time_s, "a time in seconds or as h:mm:ss", math.inf)
        priority = read.cell("priority", _priority, "a whole number", None)
        orders.append(Order(time_s or 0.0, product, quantity or 1, math.inf if due_s is None else due_s, priority))
    if sum(order.quantity for order in orders) > MOST_JOBS:
        mistakes.append(f"{shown(path.name)} orders more than {MOST_JOBS:,} jobs")
    return sorted(orders, key=lambda order: order.time_s), mistakes


def read_sequence(path: Path, products: Collection[str]) -> tuple[list[str], list[str]]:
    """The products of a file in its order, each as often as its quantity says, and the file's mistakes.

    Columns: product, and where wanted quantity. Raises RecordedError where there is no table.
    """
    _, rows = _table(path, ("product",), ("quantity",))
    mistakes: list[str] = []
    sequence: list[str] = []
    for line, row in rows:
        read = _Row(row, f"{shown(path.name)} line {line}", mistakes)
        product = read.cell("product", lambda cell: _known(cell, products), "")
        quantity = read.cell("quantity", _quantity, f"a whole number from 1 to {MOST_OF_AN_ORDER:,}", 1)
        if len(sequence) + (quantity or 1) > MOST_JOBS:
            return sequence, [*mistakes, f"{shown(path.name)} holds more than {MOST_JOBS:,} jobs"]
        sequence += [product or ""] * (quantity or 1)
    return sequence, mistakes


Table = tuple[list[str], list[tuple[int, dict[str, str]]]]


def _table(path: Path, needed: tuple[str, ...], wanted: tuple[str, ...]) -> Table:
    """The columns of a file, and its rows by column, each with its line. Raises RecordedError."""
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
        raise RecordedError(f"{where} has no rows below its heading")
    return names, [(line, dict(zip(names, (cell.strip() for cell in cells)))) for line, cells in rows]


class _NoValue(ValueError):
    """A cell that cannot be read; what it says is the hint."""


@dataclass(frozen=True, slots=True)
class _Row:
    """One row being read; what is wrong with its cells is added to ``mistakes``."""

    cells: dict[str, str]
    where: str
    mistakes: list[str]

    def cell(self, name: str, read: Callable[[str], Any], expected: str, otherwise: Any = ...) -> Any:
        """The value of a cell; ``otherwise`` where it is empty and may be, None where it is wrong."""
        text = self.cells.get(name, "")
        if not text and otherwise is not ...:
            return otherwise
        try:
            return read(text)
        except ValueError as error:
            hint = f"; {error}" if isinstance(error, _NoValue) and str(error) else ""
            found = f"{name} {shown(text)} is not {expected}" if expected else f"no {name} {shown(text)}{hint}"
            self.mistakes.append(f"{self.where}: {found}" if text else f"{self.where}: there is no {name}")
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
