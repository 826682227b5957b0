"""Rows that were not packed as they were written are packed at the end."""

from typing import Any

from opsim.log import COLUMNS, pack_row


def flush_all(floor: Any) -> None:
    """No more rows will come."""
    for row in floor.rows:
        floor.write(pack_row(*[getattr(row, name) for name in COLUMNS]))
    floor.rows.clear()
