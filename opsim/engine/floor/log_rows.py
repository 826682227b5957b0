"""Rows of the event log, packed as ``opsim.log`` packs them: two or three an operation.

Rows that were not packed as they were written are packed at the end.
"""

from __future__ import annotations

from math import nan
from typing import Any

from opsim.engine.floor.floor_state import Row
from opsim.log import COLUMNS, SETUP, WALK, WORK, pack_row


def new_row(floor: Any, kind: int, start_s: float) -> Any:
    """A row of a kind from a time until now, with nothing else in it yet: it is packed at the end."""
    row = Row()
    row.kind, row.start_s, row.end_s = kind, start_s, floor.now
    row.worker = row.station = row.place_from = row.place_to = row.source = row.job = -1
    row.product = row.operation = row.task = row.performance_id = row.k = -1
    row.progress_from = row.progress_to = row.pace_shift = nan
    floor.rows.append(row)
    return row


def name_job(row: Any, job: Any) -> None:
    """The row is of a job."""
    row.source, row.job, row.product, row.operation = job.source, job.number, job.product, job.operation


def progress(job: Any, now: float) -> float:
    """How much of the performance under way is done, as a share of the whole of it."""
    spent_s = now - job.since_s
    if spent_s == job.duration_s:
        return 1.0
    before: float = job.progress_from
    return before + (1.0 - before) * (spent_s / job.duration_s)


def log_job(floor: Any, job: Any) -> None:
    """Write the state the job was in until now, where it lasted."""
    # NOTE: the rows of ``opsim.log.row`` written out and packed here, without a Row between.
    start_s, now = job.since_s, floor.now
    if now <= start_s:
        return
    kind = job.kind
    if kind == WORK or kind == SETUP:  # noqa: SIM109  NOTE: twice as fast as a tuple
        to = 1.0 if now - start_s == job.duration_s else progress(job, now)
        floor.write(pack_row(
            kind, start_s, now, job.worker, job.station.rank, -1, -1, job.source, job.number, job.product,
            job.operation, job.task, job.performance_id, job.k, job.progress_from, to, job.pace_shift, 0,
        ))  # fmt: skip
    else:
        floor.write(pack_row(
            kind, start_s, now, -1, job.station.rank, -1, -1, job.source, job.number, job.product,
            job.operation, -1, -1, -1, nan, nan, nan, job.cause,
        ))  # fmt: skip


def job_now(floor: Any, job: Any, kind: int, cause: int) -> None:
    """The job changes its state: the old one is written, the new one begins."""
    now = floor.now
    if now > job.since_s:
        log_job(floor, job)
    job.kind, job.cause, job.since_s = kind, cause, now


def log_instant(floor: Any, kind: int, job: Any, cause: int, station: int, other: int) -> None:
    """Write something that happened to a job at once; at a station and with another job, or -1."""
    now = floor.now
    floor.write(pack_row(
        kind, now, now, -1, station, -1, -1, job.source, job.number, job.product, job.operation,
        -1, -1, other, nan, nan, nan, cause,
    ))  # fmt: skip


def _log_stint(floor: Any, worker: Any) -> None:
    """Write the part of a team's member until now, which began when his state did; it names no job."""
    stint, start_s, now = worker.stint, worker.since_s, floor.now
    row = new_row(floor, WORK, start_s)
    row.worker, row.station, row.product, row.operation = worker.rank, stint.station, stint.product, stint.operation
    row.task, row.performance_id, row.k = stint.task, stint.performance_id, stint.k
    done = 1.0 if now - start_s == stint.duration_s else (now - start_s) / stint.duration_s
    row.progress_from, row.pace_shift = stint.progress_from, stint.pace_shift
    row.progress_to = 1.0 if done == 1.0 else stint.progress_from + (1.0 - stint.progress_from) * done


def log_worker(floor: Any, worker: Any) -> None:
    """Write the wait or the walk the worker was in until now; work is written with the job, unless a team does it."""
    now, kind = floor.now, worker.kind
    if now <= worker.since_s:
        return
    if kind == WORK or kind == SETUP:  # noqa: SIM109
        if worker.stint:
            _log_stint(floor, worker)
        return
    walking = kind == WALK
    job, station = worker.job, worker.station
    place_from, cause = (worker.walk_from, 0) if walking else (worker.place, worker.cause)
    if job is None:
        source = number = product = operation = -1
    else:
        source, number, product, operation = job.source, job.number, job.product, job.operation
    floor.write(pack_row(
        kind, worker.since_s, now, worker.rank, -1 if station is None else station.rank,
        place_from, worker.place, source, number, product, operation, -1, -1, -1, nan, nan, nan, cause,
    ))  # fmt: skip


def flush_all(floor: Any) -> None:
    """No more rows will come."""
    for row in floor.rows:
        floor.write(pack_row(*[getattr(row, name) for name in COLUMNS]))
    floor.rows.clear()
