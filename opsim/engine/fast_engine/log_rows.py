"""Rows of the event log as steps write them -> columns in their one order, a few hundred at a time, in lent memory.

Rows are written when they end, so they come in the order of ``end_s`` by themselves: only those of one instant have to
be put in order. Where a block writes rows of the past at the end (closed hours), or very many end at once,
``in_order`` sorts all of them after.

NOTE: a run of 300,000 rows fills 30 MB. Asked of the system anew for each run, the first touch of every page costs
a third of the run; in a study logs come and go, one after the other.
"""

from __future__ import annotations

import ctypes
from collections import deque
from collections.abc import Iterable
from contextlib import suppress
from typing import Any
from weakref import finalize

import numpy as np

from opsim.engine.fast_engine.event_list import NAN
from opsim.engine.fast_engine.floor_state import Floor, Row
from opsim.engine.fast_engine.machine import Arena, Array, Handle, call_out, cast, inlined, step
from opsim.engine.fast_engine.machine.arena import MORE
from opsim.engine.fast_engine.machine.intrinsics import set_byte, set_half, words_at
from opsim.engine.fast_engine.machine.lists import take_bytes
from opsim.engine.fast_engine.machine.structs import LAYOUTS, size_of
from opsim.engine.fast_engine.state import Job, Worker
from opsim.log import COLUMNS, ORDER, SETUP, WALK, WORK

ROW_BYTES = size_of(Row)
_as_row = cast(Row)


@inlined
def new_row(floor: Floor, kind: int, start_s: float) -> Row:
    """A row of a kind from a time until now, with nothing else in it."""
    if floor.row_at == floor.row_end:
        floor.flush_line(floor)
    row: Row = _as_row(floor.row_at)
    floor.row_at += ROW_BYTES
    row.kind, row.start_s, row.end_s = kind, start_s, floor.now
    row.worker = row.station = row.place_from = row.place_to = row.source = row.job = -1
    row.product = row.operation = row.task = row.performance_id = row.k = -1
    row.progress_from = row.progress_to = row.pace_shift = NAN
    row.cause = 0
    return row


@inlined
def name_job(row: Row, job: Job) -> None:
    """The row is of a job."""
    row.source, row.job, row.product, row.operation = job.source, job.number, job.product, job.operation


@inlined
def progress(job: Job, now: float) -> float:
    """How much of the performance under way is done, as a share of the whole of it."""
    spent_s = now - job.since_s
    if spent_s == job.duration_s:
        return 1.0
    before = job.progress_from
    return before + (1.0 - before) * (spent_s / job.duration_s)


@inlined
def log_job(floor: Floor, job: Job) -> None:
    """Write the state the job was in until now, where it lasted."""
    if floor.now <= job.since_s:
        return
    row = new_row(floor, job.kind, job.since_s)
    row.station = job.station.rank
    name_job(row, job)
    if job.kind == WORK or job.kind == SETUP:
        row.worker, row.task, row.performance_id, row.k = job.worker, job.task, job.performance_id, job.k
        row.progress_from, row.progress_to, row.pace_shift = job.progress_from, progress(job, floor.now), job.pace_shift
    else:
        row.cause = job.cause


@inlined
def job_now(floor: Floor, job: Job, kind: int, cause: int) -> None:
    """The job changes its state: the old one is written, the new one begins."""
    log_job(floor, job)
    job.kind, job.cause, job.since_s = kind, cause, floor.now


@inlined
def log_instant(floor: Floor, kind: int, job: Job, cause: int, station: int, other: int) -> None:
    """Write something that happened to a job at once; at a station and with another job, or -1."""
    row = new_row(floor, kind, floor.now)
    name_job(row, job)
    row.station, row.k, row.cause = station, other, cause


@inlined
def log_stint(floor: Floor, worker: Worker) -> None:
    """Write the part of a team's member until now, which began when his state did; it names no job."""
    stint, start_s, now = worker.stint, worker.since_s, floor.now
    row = new_row(floor, WORK, start_s)
    row.worker, row.station, row.product, row.operation = worker.rank, stint.station, stint.product, stint.operation
    row.task, row.performance_id, row.k = stint.task, stint.performance_id, stint.k
    done = 1.0 if now - start_s == stint.duration_s else (now - start_s) / stint.duration_s
    row.progress_from, row.pace_shift = stint.progress_from, stint.pace_shift
    row.progress_to = 1.0 if done == 1.0 else stint.progress_from + (1.0 - stint.progress_from) * done


@inlined
def log_worker(floor: Floor, worker: Worker) -> None:
    """Write the wait or the walk the worker was in until now; work is written with the job, unless a team does it."""
    if floor.now <= worker.since_s:
        return
    if worker.kind == WORK or worker.kind == SETUP:
        if worker.stint:
            log_stint(floor, worker)
        return
    row = new_row(floor, worker.kind, worker.since_s)
    row.worker, row.place_from, row.place_to = worker.rank, worker.place, worker.place
    if worker.station:
        row.station = worker.station.rank
    if worker.kind == WALK:
        row.place_from = worker.walk_from
    else:
        row.cause = worker.cause
    if worker.job:
        name_job(row, worker.job)


AT_ONCE = 256
"""Rows before they are put into columns: as many as stay in the fastest memory."""
MOST_SORTED = 4096
"""Rows of one instant: of more, insertion would take minutes, and all rows are sorted at the end instead."""
WORDS = ROW_BYTES // 8


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


MOST_KEPT, MOST_BYTES = 4, 1 << 28
"""Of what nobody has: so many, and together so much."""
MOST_WASTE = 4
"""Times what was asked for: larger memory is not lent for it."""
_kept: deque[np.ndarray] = deque()
"""What came back last comes first. NOTE: memory comes back whenever Python collects what is unused, also in the middle
of the functions here. So there is no lock: each block is taken out before it is looked at."""


def lent(n_bytes: int) -> np.ndarray:
    """(n_bytes or more,) bytes, of any content. Arrays made from it keep it; when the last one is gone it is free."""
    memory = _taken(n_bytes)
    lease: Any = (ctypes.c_uint8 * memory.nbytes).from_address(memory.ctypes.data)
    finalize(lease, _keep, memory).atexit = False
    return np.frombuffer(lease, dtype=np.uint8)


def _taken(n_bytes: int) -> np.ndarray:
    """The smallest of those that are kept and large enough, and not far too large; else new memory."""
    kept = _all_taken()
    fitting = [number for number, memory in enumerate(kept) if n_bytes <= memory.nbytes <= MOST_WASTE * n_bytes]
    if not fitting:
        _put_back(kept)
        return np.empty(n_bytes, dtype=np.uint8)
    found = kept.pop(min(fitting, key=lambda number: kept[number].nbytes))
    _put_back(kept)
    return found


def _keep(memory: np.ndarray) -> None:
    _put_back([memory, *_all_taken()])


def _all_taken() -> list[np.ndarray]:
    found: list[np.ndarray] = []
    while True:
        try:
            found.append(_kept.popleft())
        except IndexError:
            return found


def _put_back(blocks: Iterable[np.ndarray]) -> None:
    """As many as may be kept, those that come first."""
    n, n_bytes = 0, 0
    for memory in blocks:
        if n < MOST_KEPT and n_bytes + memory.nbytes <= MOST_BYTES:
            n, n_bytes = n + 1, n_bytes + memory.nbytes
            _kept.append(memory)


FEWEST = (1 << 14) + 64
_KINDS = {name: np.dtype(kind) for name, kind in COLUMNS.items()}
_ENDS = np.cumsum([kind.itemsize for kind in _KINDS.values()])
ROOM_BYTES = int(_ENDS[-1])
"""Of one row in all columns."""
_STARTS = _ENDS - [kind.itemsize for kind in _KINDS.values()]
"""Bytes of a row in the columns before each."""


class Columns:
    """Of one floor, run after run: side by side in memory that is lent, whole pieces of 64 bytes each."""

    def __init__(self, arena: Arena, floor: Handle):
        self.floor, handle = floor, arena.new("Columns")
        assert list(LAYOUTS["Columns"].fields) == list(COLUMNS), "addresses are not in the order of the columns"
        words: Any = (ctypes.c_int64 * len(COLUMNS)).from_address(handle.address)
        self._words = np.frombuffer(words, np.int64)
        self._more = MORE(self._give_more)
        floor.more_rows = ctypes.cast(self._more, ctypes.c_void_p).value
        floor.columns = handle
        floor.row_first = floor.row_at = arena.take(AT_ONCE * ROW_BYTES)
        floor.row_end = floor.row_first + AT_ONCE * ROW_BYTES
        floor.row_order = arena.take(AT_ONCE * 8)
        self._n = self._room = FEWEST
        self._memory = np.empty(0, np.uint8)

    def begin(self) -> None:
        """A run begins: nothing is written yet."""
        self._take(self._n)

    def end(self) -> dict[str, np.ndarray]:
        """The columns that were written; they are the caller's from now on."""
        n = self.floor.n_rows
        self._n = max(FEWEST, n + n // 16)
        found, self._memory = self._written(n), np.empty(0, np.uint8)
        return in_order(found) if self.floor.unordered else found

    def _written(self, n: int) -> dict[str, np.ndarray]:
        """The first n rows."""
        starts = (self._room * _STARTS).tolist()
        return {name: np.ndarray(n, kind, self._memory, at) for (name, kind), at in zip(_KINDS.items(), starts)}

    def _give_more(self, _: int, n_rows: int) -> int:
        """Called by the engine: room for so many rows at least. It raises MemoryError where there is none."""
        with suppress(MemoryError):
            n = self.floor.n_rows
            before = self._written(n)
            self._take(max(2 * self._room, n_rows))
            for old, new in zip(before.values(), self._written(n).values()):
                new[:] = old
        return 0

    def _take(self, n_rows: int) -> None:
        """Room for so many rows or some more.

        NOTE: an odd number of pieces. Of an even one columns lie whole pages apart, which the fastest memory keeps in
        the same few places: that took 1 to 3 % of a run.
        """
        room = 64 * (-(-n_rows // 64) | 1)
        self._memory, self._room = lent(room * ROOM_BYTES), room
        np.add(room * _STARTS, self._memory.__array_interface__["data"][0], out=self._words)
        self.floor.room = room
