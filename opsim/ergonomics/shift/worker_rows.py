"""Rows of work as an EventLog that can be looked at: from pieces of performances, or from a log of workers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from opsim.log import CAUSES, KINDS, NAMED, OFF, ORDER, WORK, WORKER_KINDS, EventLog, event_log, row
from opsim.names import natural_key
from opsim.performance import Performance


def natural(names: Iterable[str]) -> tuple[str, ...]:
    """Names, each once, in natural order."""
    return tuple(sorted(set(names), key=natural_key))


def rows_of(pieces: Sequence[Performance], replication: int) -> EventLog:
    """Work, a row a piece; pieces that took no time give none."""
    workers, tasks = natural(one.worker for one in pieces), natural(one.task for one in pieces)
    worked = [
        row(
            *(WORK, one.start_s, one.end_s, workers.index(one.worker)),
            task=tasks.index(one.task),
            performance_id=one.number,
            k=one.k,
            progress_from=one.progress_from,
            progress_to=one.progress_to,
            pace_shift=one.pace_shift,
        )
        for one in pieces
        if one.end_s > one.start_s
    ]
    named = {"kind": KINDS, "cause": CAUSES, "worker": workers, "task": tasks}
    names: dict[str, tuple[str, ...]] = {column: named.get(column, ()) for column in NAMED}
    return event_log(worked, max((one.end_s for one in pieces), default=0.0), names, replication)


def whole_days(log: EventLog, tasks: Iterable[str], low_s: float) -> EventLog:
    """The same rows and, for each worker, ``off`` between: whoever has no row is not there.

    tasks : names, by which tasks are numbered from now on in natural order; those of the log among them
    low_s : from when on somebody is looked at; until the log's horizon
    Raises ValueError where somebody does two things at once.
    """
    names = natural([*tasks, *log.names["task"]])
    rank = np.array([*(names.index(name) for name in log.names["task"]), -1], np.int32)
    off = event_log(_gaps(log, low_s), log.horizon_s, {})
    columns = {name: np.concatenate([log[name], off[name]]) for name in log.columns}
    columns["task"] = rank[columns["task"]]
    order = np.lexsort([columns[name] for name in reversed(ORDER)])
    found = {name: column[order] for name, column in columns.items()}
    return EventLog(log.replication, log.horizon_s, found, {**log.names, "task": names})


def only(log: EventLog, workers: Sequence[int]) -> EventLog:
    """The same rows by number; whoever is not among some workers is off in all of his."""
    others = (log["worker"] >= 0) & ~np.isin(log["worker"], list(workers))
    return EventLog(
        log.replication,
        log.horizon_s,
        {**log.columns, "kind": np.where(others, OFF, log["kind"]).astype(log["kind"].dtype)},
        log.names,
    )


def _gaps(log: EventLog, low_s: float) -> Iterator[tuple]:
    """Rows of the times in which a worker has none."""
    states = np.isin(log["kind"], WORKER_KINDS)
    for worker, name in enumerate(log.names["worker"]):
        rows = np.flatnonzero(states & (log["worker"] == worker) & (log["end_s"] > log["start_s"]))
        rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
        until_s = np.r_[-np.inf, log["end_s"][rows]]
        begun_s = np.r_[log["start_s"][rows], np.inf]
        for at in np.flatnonzero(begun_s[:-1] < until_s[:-1]).tolist():
            raise ValueError(
                f"worker {name}: something else begins at {begun_s[at]:g} s, while the piece before lasts until "
                f"{until_s[at]:g} s; is a piece given twice?"
            )
        for from_s, to_s in zip(np.maximum(until_s, low_s), np.minimum(begun_s, log.horizon_s)):
            if to_s > from_s:
                yield row(OFF, float(from_s), float(to_s), worker)
