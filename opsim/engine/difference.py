"""Two event logs that should be the same: the first row in which they are not, column by column, to the last bit."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.log import COLUMNS, NAMED, EventLog

AROUND = 3
"""Rows that are shown before and behind the first one that differs."""


@dataclass(frozen=True)
class Cell:
    """One column of the first row that differs, as text in either log; "" where a row has nothing there."""

    column: str
    one: str
    other: str
    differs: bool


@dataclass(frozen=True)
class Difference:
    """row : number of the first row that differs, None where not rows but what they stand for differs

    said    : in a sentence, what differs
    columns : names of the columns that differ in that row; none where one log has no such row
    """

    one: EventLog
    other: EventLog
    row: int | None
    said: str
    columns: tuple[str, ...] = ()

    def cells(self) -> list[Cell]:
        """The row in both logs, a cell a column."""
        if self.row is None:
            return []
        one, other = shown_row(self.one, self.row), shown_row(self.other, self.row)
        missing = not one or not other
        return [Cell(c, one.get(c, ""), other.get(c, ""), missing or c in self.columns) for c in COLUMNS]

    def around(self) -> Iterator[tuple[str, int, dict[str, str]]]:
        """(whose, number, row) of the rows before, which are the same in ``both``, and of each log from there on."""
        if self.row is None:
            return
        for number in range(max(0, self.row - AROUND), self.row):
            yield "both", number, shown_row(self.one, number)
        for whose, log in (("one", self.one), ("other", self.other)):
            for number in range(self.row, min(len(log), self.row + AROUND + 1)):
                yield whose, number, shown_row(log, number)


def difference(one: EventLog, other: EventLog) -> Difference | None:
    """In what two logs of one replication differ first; None where they are the same in every bit.

    What is not a number equals what is not a number; 0.0 and -0.0 differ.
    """
    said = [*_heads(one, other)]
    if said:
        return Difference(one, other, None, "; ".join(said))
    n = min(len(one), len(other))
    unlike = {name: _unlike(one[name][:n], other[name][:n]) for name in COLUMNS}
    anywhere = np.logical_or.reduce([*unlike.values()])
    if anywhere.any():
        row = int(np.argmax(anywhere))
        columns = tuple(name for name in COLUMNS if unlike[name][row])
        return Difference(one, other, row, f"row {row:,} differs in {', '.join(columns)}", columns)
    if len(one) == len(other):
        return None
    return Difference(
        one, other, n, f"one has {len(one):,} rows, the other {len(other):,}; the first {n:,} are the same"
    )


def shown_row(log: EventLog, row: int) -> dict[str, str]:
    """Column -> text of a row, names as names, numbers to the last bit; empty where there is no such row."""
    return {name: _text(log, name, log[name][row]) for name in COLUMNS} if row < len(log) else {}


def _heads(one: EventLog, other: EventLog) -> Iterator[str]:
    """What differs beside the rows, in words."""
    if one.replication != other.replication:
        yield f"replication {one.replication} and {other.replication}"
    if one.horizon_s != other.horizon_s:
        yield f"horizon {one.horizon_s!r} s and {other.horizon_s!r} s"
    for name in NAMED:
        if one.names.get(name) != other.names.get(name):
            yield f"the names of column {name}"
    for name in COLUMNS:
        types = [log.columns[name].dtype if name in log.columns else None for log in (one, other)]
        if types[0] != types[1]:
            yield f"column {name} holds {types[0]} and {types[1]}"


def _unlike(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(rows,) whether values differ in a bit."""
    if one.dtype.kind != "f":
        return np.asarray(one != other)
    bits = np.ascontiguousarray(one).view(np.int64) != np.ascontiguousarray(other).view(np.int64)
    return np.asarray(bits & ~(np.isnan(one) & np.isnan(other)))


def _text(log: EventLog, column: str, value: Any) -> str:
    if column in NAMED:
        names = log.names[column]
        return "" if value < 0 else names[value] if value < len(names) else f"no name: {value}"
    if COLUMNS[column] is np.float64:
        return "" if np.isnan(value) else repr(float(value))
    return "" if value < 0 else str(value)
