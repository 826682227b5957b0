"""Rows of the event log: of jobs, workers, instants; those of ``floor.parts.rows``."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import cast, inlined, tell_0
from opsim.engine.fast_engine.machine.structs import size_of
from opsim.engine.fast_engine.parts.clock import NAN
from opsim.engine.fast_engine.parts.records import Row
from opsim.engine.fast_engine.parts.state import Floor, Job, Worker
from opsim.log import SETUP, WALK, WORK

ROW_BYTES = size_of(Row)
_as_row = cast(Row)


@inlined
def new_row(floor: Floor, kind: int, start_s: float) -> Row:
    """A row of a kind from a time until now, with nothing else in it."""
    if floor.row_at == floor.row_end:
        tell_0(floor.flush_line, floor)
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
