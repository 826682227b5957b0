"""Who does the same again and again: performances of one task a minute, from rows of the log alone."""

from __future__ import annotations

import numpy as np

from opsim.clock import STEP_S
from opsim.log import SETUP, WORK, EventLog

MINUTE_S = 60.0
NAME = ("worker", "task", "station", "k")
"""Whose performance it is, and which: k counts a worker's own, and at each station its attended ones. A number of the
performance does not tell: of one that somebody helps with, each part has its own."""
REPEATED = 4
"""Performances of one task a minute from which work is repeated: of 4, a cycle of 15 s or less.

Beginnings are posts and cycles the fence between: so many beginnings whose first and last are no further apart than one
cycle less. Source: McAtamney & Corlett 1993, RULA, Applied Ergonomics 24(2), 91-99: muscle use, "repeated more than 4
times/minute" and its worksheets "4 times per minute or more"; Hignett & McAtamney 2000, REBA, Applied Ergonomics 31,
201-205; that a rate is counted by cycles: design.
"""


def repeated_rows(log: EventLog, times: int = REPEATED, within_s: float = MINUTE_S) -> np.ndarray:
    """(rows,) bool: work of a worker who did the same task at a rate of at least ``times`` in ``within_s``.

    That is one of ``times`` beginnings, one after the other, whose first and last are at most within_s x (times - 1) /
    times apart: 45 s for 4 a minute, as of tasks that begin every 15 s. Pieces of a performance begin with its first;
    set-ups are tasks too; rows of nobody, or of no task, are never repeated.
    """
    rows = done_by_workers(log)
    first = _first_pieces(log, rows)
    begun = rows[first]
    marked = _crowded(log["worker"][begun], log["task"][begun], log["start_s"][begun], times, within_s)
    found = np.zeros(len(log), bool)
    found[rows] = marked[np.cumsum(first) - 1]
    return found


def begun(log: EventLog) -> np.ndarray:
    """(n,) rows with which a worker begins a performance of a task, by worker, task, station and k."""
    rows = done_by_workers(log)
    return rows[_first_pieces(log, rows)]


def done_by_workers(log: EventLog) -> np.ndarray:
    """(n,) rows in which a worker performs a task, by ``NAME`` and time."""
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0) & (log["task"] >= 0))
    return rows[np.lexsort([log[name][rows] for name in ("start_s", *reversed(NAME))])]


def _first_pieces(log: EventLog, rows: np.ndarray) -> np.ndarray:
    """(n,) bool: of rows by ``NAME`` and time, those with which a performance begins."""
    first = np.ones(rows.size, bool)
    for name in NAME:
        column = log[name][rows]
        first[1:] &= column[1:] == column[:-1]
    first[1:] = ~first[1:]
    return first


def _crowded(worker: np.ndarray, task: np.ndarray, begin_s: np.ndarray, times: int, within_s: float) -> np.ndarray:
    """(n,) bool: beginnings of which so many, of one worker and task, are so many in ``within_s`` or quicker."""
    found = np.zeros(begin_s.size, bool)
    order = np.lexsort([begin_s, task, worker])
    first, last = order[: max(order.size - times + 1, 0)], order[times - 1 :]
    alike = (worker[first] == worker[last]) & (task[first] == task[last])
    longest_s = within_s * (times - 1) / times + STEP_S / 2
    starts = np.flatnonzero(alike & (begin_s[last] - begin_s[first] <= longest_s))
    for step in range(times):
        found[order[starts + step]] = True
    return found
