"""The log of a floor that goes on: its rows so far, and those that are open as they are now."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from opsim.engine.floor.settle import close
from opsim.log import ORDER, EventLog, LogWriter


def log_so_far(floor: Any, replication: int, now_s: float, names: dict[str, tuple[str, ...]]) -> EventLog:
    """The log as if the horizon were now, in seconds of the floor's clock; the floor is as it was, and goes on."""
    writer, kept = LogWriter(), (floor.now, floor.horizon_s, floor.write, floor.rows)
    writer.rows.extend(floor.log.rows)
    since_s = [(job, job.since_s) for job in _jobs(floor)]  # a wait for tools that is written ends for the job, too
    floor.horizon_s, floor.write, floor.rows = now_s, writer.rows.extend, list(floor.rows)
    try:
        close(floor)
    finally:
        floor.now, floor.horizon_s, floor.write, floor.rows = kept
        for job, was_s in since_s:
            job.since_s = was_s
    return _until(writer.close(replication, now_s, names))


def _jobs(floor: Any) -> Iterator[Any]:
    job = floor.first_job
    while job is not None:
        yield job
        job = job.next_on_floor


def _until(log: EventLog) -> EventLog:
    """Nothing after the log's end: hours in which stations are closed are known ahead, and written whole."""
    ends_s, at_s = log["end_s"], log.horizon_s
    if not np.any(ends_s > at_s):
        return log
    kept = log.where((ends_s <= at_s) | (log["start_s"] < at_s))
    columns = {**kept.columns, "end_s": np.minimum(kept["end_s"], at_s)}
    order = np.lexsort([columns[name] for name in reversed(ORDER)])
    return EventLog(log.replication, at_s, columns, log.names).where(order)
