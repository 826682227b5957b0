"""Who does the same again and again: performances of one task a minute, from rows of the log alone."""

from __future__ import annotations

import numpy as np

from opsim.log import SETUP, WORK, EventLog

MINUTE_S = 60.0
REPEATED = 4
"""Performances of one task within a minute from which work is repeated.

Source: McAtamney & Corlett 1993, RULA, Applied Ergonomics 24(2), 91-99: muscle use, "repeated more than 4 times/minute"
and its worksheets "4 times per minute or more"; Hignett & McAtamney 2000, REBA, Applied Ergonomics 31, 201-205.
"""


def repeated_rows(log: EventLog, times: int = REPEATED, within_s: float = MINUTE_S) -> np.ndarray:
    """(rows,) bool: work of a worker who began the same task so often in some minute that holds this beginning.

    A minute slides and ends before its last instant: tasks that begin every 15 s are repeated 4 times in it. Pieces of
    a performance begin with its first; set-ups are tasks too; rows of nobody, or of no task, are never repeated.
    """
    rows = done_by_workers(log)
    first = _first_pieces(log, rows)
    begun = rows[first]
    marked = _crowded(log["worker"][begun], log["task"][begun], log["start_s"][begun], times, within_s)
    found = np.zeros(len(log), bool)
    found[rows] = marked[np.cumsum(first) - 1]
    return found


def begun(log: EventLog) -> np.ndarray:
    """(n,) rows with which a worker begins a performance of a task, by worker, task and k."""
    rows = done_by_workers(log)
    return rows[_first_pieces(log, rows)]


def done_by_workers(log: EventLog) -> np.ndarray:
    """(n,) rows in which a worker performs a task, by worker, task, k and time."""
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0) & (log["task"] >= 0))
    return rows[np.lexsort([log[name][rows] for name in ("start_s", "k", "task", "worker")])]


def _first_pieces(log: EventLog, rows: np.ndarray) -> np.ndarray:
    """(n,) bool: of rows by worker, task, k and time, those with which a performance begins."""
    first = np.ones(rows.size, bool)
    for name in ("worker", "task", "k"):
        column = log[name][rows]
        first[1:] &= column[1:] == column[:-1]
    first[1:] = ~first[1:]
    return first


def _crowded(worker: np.ndarray, task: np.ndarray, begin_s: np.ndarray, times: int, within_s: float) -> np.ndarray:
    """(n,) bool: beginnings of which so many, of one worker and task, lie within less than ``within_s``."""
    found = np.zeros(begin_s.size, bool)
    order = np.lexsort([begin_s, task, worker])
    first, last = order[: max(order.size - times + 1, 0)], order[times - 1 :]
    alike = (worker[first] == worker[last]) & (task[first] == task[last])
    starts = np.flatnonzero(alike & (begin_s[last] - begin_s[first] < within_s))
    for step in range(times):
        found[order[starts + step]] = True
    return found
