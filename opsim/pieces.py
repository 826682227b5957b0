"""What became of each performance that was broken off: its pieces, in order, job by job."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.log import SETUP, WORK, EventLog

FATES = ("finished", "resumed", "by_another", "handed_over", "restarted", "open")
"""What becomes of the rest of a piece: nothing is left; who did it goes on; another one does, later or at once; all of
it is begun anew; or nobody goes on with it until the run ends or the job is gone."""
FINISHED, RESUMED, BY_ANOTHER, HANDED_OVER, RESTARTED, OPEN = range(len(FATES))


@dataclass(frozen=True)
class JobPieces:
    """Pieces of work and of set-ups by job, work before set-ups, and time; every array is (P,).

    row    : which row of the log it is
    before : the piece before it of the same job and kind, -1 where there is none; left : whether a rest of it was left
    fate   : the number of what becomes of its own rest, in ``FATES``
    """

    row: np.ndarray
    before: np.ndarray
    left: np.ndarray
    fate: np.ndarray


def job_pieces(log: EventLog) -> JobPieces:
    """All pieces that name a job; the parts that members of a team have beside them do not."""
    rows = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["job"] >= 0))
    rows = rows[np.lexsort([log["start_s"][rows], log["kind"][rows], log["job"][rows]])]
    follows = np.zeros(rows.size, dtype=bool)
    follows[1:] = _same(log, rows, "job", "kind")
    left = follows.copy()
    left[1:] &= log["progress_to"][rows][:-1] < 1.0
    return JobPieces(rows, np.where(follows, np.arange(rows.size) - 1, -1), left, _fates(log, rows, left))


def _fates(log: EventLog, rows: np.ndarray, left: np.ndarray) -> np.ndarray:
    """(P,) what becomes of each piece's rest."""
    fate = np.where(log["progress_to"][rows] < 1.0, OPEN, FINISHED)
    if not rows.size:
        return fate
    at_once = log["start_s"][rows][1:] == log["end_s"][rows][:-1]
    met = np.where(at_once & ~_same(log, rows, "worker"), HANDED_OVER, BY_ANOTHER)
    met = np.where(_same(log, rows, "performance_id"), RESUMED, met)
    met = np.where(log["progress_from"][rows][1:] == 0.0, RESTARTED, met)
    met = np.where(_same(log, rows, "task", "station"), met, OPEN)
    fate[:-1] = np.where(left[1:], met, fate[:-1])
    return fate


def _same(log: EventLog, rows: np.ndarray, *columns: str) -> np.ndarray:
    """(P - 1,) whether a row agrees with the one before it in all of some columns."""
    return np.all([log[name][rows][1:] == log[name][rows][:-1] for name in columns], axis=0)
