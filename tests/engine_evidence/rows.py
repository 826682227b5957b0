"""Where two logs are not the same: the first row that differs, in words."""

from __future__ import annotations

from opsim.engine.difference import difference, shown_row
from opsim.log import EventLog


def first_difference(one: EventLog, other: EventLog, names: tuple[str, str] = ("simpy", "fast")) -> str:
    """What differs first between two logs, by row and column; nothing where they are equal to the last bit."""
    found = difference(one, other)
    if found is None or found.row is None:
        return "" if found is None else found.said
    columns = f": {', '.join(found.columns)}" if found.columns else ""
    lines = [f"row {found.row} of {len(one)} and {len(other)}{columns}"]
    return "\n".join([*lines, *(f"    {name:<7}{words(log, found.row)}" for name, log in zip(names, (one, other)))])


def words(log: EventLog, row: int) -> str:
    """A row in words: what it has of each column, names instead of numbers, times with all their digits."""
    shown = shown_row(log, row)
    return " ".join(f"{column}={text}" for column, text in shown.items() if text) or "has no such row"
