"""Rows as steps write them -> columns of an EventLog, in their one order, a few hundred at a time.

Rows are written when they end, so they come in the order of ``end_s`` by themselves: only those of one instant have to
be put in order. Where a block writes rows of the past at the end (closed hours), or very many end at once,
``in_order`` sorts all of them after.
"""

from __future__ import annotations

import numpy as np

from opsim.engine.fast_engine.machine import Array, call_out, cast, inlined, step
from opsim.engine.fast_engine.machine.memory import take_bytes, words_at
from opsim.engine.fast_engine.machine.narrow import set_byte, set_half
from opsim.engine.fast_engine.parts.records import Row
from opsim.engine.fast_engine.parts.rows import ROW_BYTES
from opsim.engine.fast_engine.parts.state import Floor
from opsim.log import ORDER

AT_ONCE = 256
"""Rows before they are put into columns: as many as stay in the fastest memory."""
MOST_SORTED = 4096
"""Rows of one instant: of more, insertion would take minutes, and all rows are sorted at the end instead."""
WORDS = ROW_BYTES // 8
_as_row = cast(Row)


@step
def flush_rows(floor: Floor) -> None:
    """Put what was written into columns, in order; those of the instant at hand stay, since more may come."""
    first, n = floor.row_first, (floor.row_at - floor.row_first) // ROW_BYTES
    ready = n
    while ready and _row(first, ready - 1).end_s == floor.now:
        ready -= 1
    put_rows(floor, ready)
    for i in range(n - ready):
        _copy(first, ready + i, i)
    floor.row_at = first + (n - ready) * ROW_BYTES
    if 2 * (n - ready) > n:
        _have_twice_the_room(floor, n - ready)


@step
def flush_all(floor: Floor) -> None:
    """Put everything into columns: no more rows will come."""
    put_rows(floor, (floor.row_at - floor.row_first) // ROW_BYTES)


@inlined
def _have_twice_the_room(floor: Floor, n: int) -> None:
    n_bytes = floor.row_end - floor.row_first
    made = take_bytes(floor.memory, 2 * n_bytes)
    old, new = words_at(floor.row_first), words_at(made)
    for i in range(n * WORDS):
        new[i] = old[i]
    floor.row_first, floor.row_at, floor.row_end = made, made + n * ROW_BYTES, made + 2 * n_bytes
    floor.row_order = words_at(take_bytes(floor.memory, 16 * n_bytes // ROW_BYTES))


@inlined
def _row(first: int, number: int) -> Row:
    return _as_row(first + number * ROW_BYTES)


@inlined
def _copy(first: int, source: int, goal: int) -> None:
    """A row onto another one."""
    old, new = words_at(first + source * ROW_BYTES), words_at(first + goal * ROW_BYTES)
    for i in range(WORDS):
        new[i] = old[i]


@inlined
def _comes_before(one: Row, other: Row) -> bool:
    """By ``ORDER``."""
    if one.end_s != other.end_s:
        return one.end_s < other.end_s
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


assert ORDER == ("end_s", "start_s", "kind", "worker", "station", "source", "job", "k"), "_comes_before differs"


@inlined
def _sort(first: int, n: int, order: Array[int]) -> None:
    """Numbers of rows in order, those alike as they were written: by insertion, as they nearly are."""
    for number in range(n):
        here, row = number, _row(first, number)
        while here and _comes_before(row, _row(first, order[here - 1])):
            order[here] = order[here - 1]
            here -= 1
        order[here] = number


@inlined
def _as_written(n: int, order: Array[int]) -> None:
    for number in range(n):
        order[number] = number


@step
def put_rows(floor: Floor, n: int) -> None:
    """The first n rows behind those in the columns; ``floor.unordered`` says where they may not belong there.

    Raises MemoryError.
    """
    if floor.n_rows + n > floor.room:
        call_out(floor.more_rows, 0, floor.n_rows + n)
        if floor.n_rows + n > floor.room:
            raise MemoryError
    columns, at, first, order = floor.columns, floor.n_rows, floor.row_first, floor.row_order
    if n > MOST_SORTED:
        _as_written(n, order)
        floor.unordered = 1
    else:
        _sort(first, n, order)
    if n and at and _row(first, order[0]).end_s <= floor.last_end_s:  # of one instant, some are in the columns already
        floor.unordered = 1
    for i in range(n):
        row, to = _row(first, order[i]), at + i
        set_byte(columns.kind, to, row.kind)
        columns.start_s[to] = row.start_s
        columns.end_s[to] = row.end_s
        set_half(columns.worker, to, row.worker)
        set_half(columns.station, to, row.station)
        set_half(columns.place_from, to, row.place_from)
        set_half(columns.place_to, to, row.place_to)
        set_half(columns.source, to, row.source)
        columns.job[to] = row.job
        set_half(columns.product, to, row.product)
        set_half(columns.operation, to, row.operation)
        set_half(columns.task, to, row.task)
        columns.performance_id[to] = row.performance_id
        columns.k[to] = row.k
        columns.progress_from[to] = row.progress_from
        columns.progress_to[to] = row.progress_to
        columns.pace_shift[to] = row.pace_shift
        set_byte(columns.cause, to, row.cause)
    if n:
        floor.last_end_s = _row(first, order[n - 1]).end_s
    floor.n_rows = at + n


def in_order(columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """All rows in the order of ``ORDER``, those alike as they were."""
    order = np.lexsort([columns[name] for name in reversed(ORDER)])
    return {name: column[order] for name, column in columns.items()}
