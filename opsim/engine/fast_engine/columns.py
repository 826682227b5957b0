"""Rows as the engine writes them -> columns of an EventLog, in their one order.

Rows are written when they end, so they come in the order of ``end_s`` by themselves: only those of one instant have to
be put in order. Where a block writes rows of the past at the end (closed hours), all are sorted first.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from opsim.engine.fast_engine.machine import cast, inlined
from opsim.engine.fast_engine.machine.compiling import entered
from opsim.engine.fast_engine.parts.rows import ROW_BYTES
from opsim.engine.fast_engine.parts.state import Row
from opsim.log import COLUMNS, ORDER

CHUNK = 1 << 13
"""Rows in a chunk."""
_as_row = cast(Row)


def columns_of(chunks: Sequence[np.ndarray], n_rows: int) -> dict[str, np.ndarray]:
    """The columns of all rows in the order of ``ORDER``; rows alike in these stay as they were written.

    chunks : of bytes, each full of CHUNK rows but for the last
    """
    at = np.array([chunk.ctypes.data for chunk in chunks], dtype=np.int64)
    end_s, order = np.empty(n_rows), np.arange(n_rows)
    if not _ends(at, end_s):
        order = np.argsort(end_s, kind="stable")
    _order_ties(at, end_s, order)
    columns = {name: np.empty(n_rows, dtype=kind) for name, kind in COLUMNS.items()}
    _fill(at, order, *columns.values())
    return columns


@inlined
def _row(at: Any, number: int) -> Row:
    """The row of a number, as it was written."""
    return _as_row(at[number // CHUNK] + (number % CHUNK) * ROW_BYTES)


@entered
def _ends(at: Any, end_s: Any) -> bool:
    """When each row ends; whether they are in the order of that."""
    in_order, last_s = True, -1.0
    for number in range(end_s.size):
        this_s = _row(at, number).end_s
        end_s[number] = this_s
        in_order = in_order and last_s <= this_s
        last_s = this_s
    return in_order


@inlined
def _comes_before(one: Row, other: Row) -> bool:
    """By ``ORDER``, of rows that end at the same time."""
    if one.start_s != other.start_s:
        return one.start_s < other.start_s
    if one.kind != other.kind:
        return one.kind < other.kind
    if one.worker != other.worker:
        return one.worker < other.worker
    if one.station != other.station:
        return one.station < other.station
    if one.source != other.source:
        return one.source < other.source
    if one.job != other.job:
        return one.job < other.job
    return one.k < other.k


assert ORDER == ("end_s", "start_s", "kind", "worker", "station", "source", "job", "k"), (
    "_comes_before is another order"
)


@entered
def _order_ties(at: Any, end_s: Any, order: Any) -> None:
    """Put the rows of each instant in order, by insertion: they are few, or nearly in order. Those alike stay as they are."""
    first = 0
    for number in range(order.size):
        if end_s[order[number]] != end_s[order[first]]:
            first = number
        here, one = number, order[number]
        row = _row(at, one)
        while here > first and _comes_before(row, _row(at, order[here - 1])):
            order[here] = order[here - 1]
            here -= 1
        order[here] = one


@entered
def _fill(
    at: Any,
    order: Any,
    kind: Any,
    start_s: Any,
    end_s: Any,
    worker: Any,
    station: Any,
    place_from: Any,
    place_to: Any,
    source: Any,
    job: Any,
    product: Any,
    operation: Any,
    task: Any,
    performance_id: Any,
    k: Any,
    progress_from: Any,
    progress_to: Any,
    pace_shift: Any,
    cause: Any,
) -> None:
    """Row after row into the columns, in the order of ``COLUMNS``."""
    for number in range(order.size):
        row = _row(at, order[number])
        kind[number], start_s[number], end_s[number] = row.kind, row.start_s, row.end_s
        worker[number], station[number] = row.worker, row.station
        place_from[number], place_to[number] = row.place_from, row.place_to
        source[number], job[number], product[number] = row.source, row.job, row.product
        operation[number], task[number] = row.operation, row.task
        performance_id[number], k[number] = row.performance_id, row.k
        progress_from[number], progress_to[number] = row.progress_from, row.progress_to
        pace_shift[number], cause[number] = row.pace_shift, row.cause
