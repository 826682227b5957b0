"""Where two logs are not the same: the first row that differs, in words."""

from __future__ import annotations

import numpy as np
from checked_floors import differ

from opsim.log import COLUMNS, NAMED, EventLog


def first_difference(one: EventLog, other: EventLog, names: tuple[str, str] = ("simpy", "fast")) -> str:
    """What differs first between two logs, by row and column; nothing where they are equal to the last bit."""
    if one.names != other.names:
        return f"the names of {', '.join(key for key in one.names if one.names[key] != other.names.get(key))}"
    columns = differ(one, other)
    if not columns:
        return ""
    row = _first_row(one, other)
    lines = [f"row {row} of {len(one)} and {len(other)}" + ("" if columns == ["rows"] else f": {', '.join(columns)}")]
    return "\n".join([*lines, *(f"    {name:<7}{words(log, row)}" for name, log in zip(names, (one, other)))])


def words(log: EventLog, row: int) -> str:
    """A row in words: what it has of each column, names instead of numbers, times with all their digits."""
    if row >= len(log):
        return "has no such row"
    said = []
    for column in COLUMNS:
        value = log[column][row].item()
        if column in NAMED:
            value = log.names[column][value] if value >= 0 else None
        if value not in (None, "", -1) and value == value:
            said.append(f"{column}={value!r}" if isinstance(value, float) else f"{column}={value}")
    return " ".join(said)


def _first_row(one: EventLog, other: EventLog) -> int:
    """The first row in which any column differs, or the first that only one of them has."""
    n = min(len(one), len(other))
    unequal = np.zeros(n, dtype=bool)
    for column, kind in COLUMNS.items():
        a, b = one[column][:n], other[column][:n]
        same = a == b
        unequal |= ~(same | (np.isnan(a) & np.isnan(b)) if kind is np.float64 else same)
    found = np.flatnonzero(unequal)
    return int(found[0]) if found.size else n
