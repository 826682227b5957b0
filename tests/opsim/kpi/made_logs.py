"""Logs small enough to check by hand, and large ones by tiling small ones."""

from math import nan

import numpy as np

from opsim.kpi import figures
from opsim.log import WORK, EventLog, event_log, names_of


def row(
    kind,
    start,
    end,
    *,
    worker=-1,
    station=-1,
    places=(-1, -1),
    job=-1,
    product=0,
    operation=None,
    task=-1,
    k=-1,
    progress=(nan, nan),
    cause=0,
):
    """A row; a row with a job is at the operation of its station's number where it names no other."""
    named = job >= 0
    return (
        *(kind, start, end, worker, station, *places, 0 if named else -1, job, product if named else -1),
        *((station if named else -1) if operation is None else operation, task, k, k, *progress, 0.0, cause),
    )


def work(start, end, station, job=0, *, worker=-1, task=0, progress=(0.0, 1.0), **more):
    """A performance, whole unless ``progress`` says otherwise."""
    return row(WORK, start, end, worker=worker, station=station, job=job, task=task, progress=progress, **more)


def made(rows, plan):
    """The log of some rows, up to the plan's horizon."""
    return event_log(rows, plan.horizon_s, names_of(plan))


def found(log, plan):
    """(kpi, subject, part) -> value of every figure."""
    return {(f.kpi, f.subject, f.part): f.value for f in figures(log, plan)}


def tiled(log: EventLog, times: int) -> EventLog:
    """A log repeated after itself: later copies are later, and their jobs and performances have new numbers."""
    copy = np.repeat(np.arange(times), len(log))
    columns = {name: np.tile(column, times) for name, column in log.columns.items()}
    for name in ("start_s", "end_s"):
        columns[name] = columns[name] + copy * log.horizon_s
    for name in ("job", "performance_id"):
        step = int(log[name].max()) + 1
        columns[name] = np.where(columns[name] >= 0, columns[name] + copy * step, -1)
    return EventLog(log.replication, log.horizon_s * times, columns, log.names)
