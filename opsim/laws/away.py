"""The law of jobs that wait for one worker: he is away, and does nothing else as long as they wait for him."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.stays import Stays, words
from opsim.log import AWAY, HELD, SETUP, WORK, EventLog
from opsim.plan import Plan


def away(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """A job waits for its worker only where its last piece was his and left something, and until he works again."""
    rows = np.flatnonzero((log["kind"] == HELD) & (log["cause"] == AWAY) & (log["job"] >= 0))
    if not rows.size:
        return
    work = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0))
    last = _last_piece(log, work[log["job"][work] >= 0], rows)
    for row in rows[(last < 0) | (log["progress_to"][last] == 1.0)][:1]:
        yield f"job {log['job'][row]}: waits for a worker at {log['start_s'][row]:g} s, and none has left work on it"
        return
    for row, piece in zip(rows, last):
        own = work[log["worker"][work] == log["worker"][piece]]
        begins, ends = ticks(log["start_s"][own]), ticks(log["end_s"][own])
        meets = (begins < ticks(log["end_s"][row])) & (ends > ticks(log["start_s"][row]))
        for at in own[meets][:1]:
            name, moment = plan.workers[log["worker"][piece]].name, words(ticks(log["start_s"][at]))
            yield f"job {log['job'][row]}: waits for {name}, who is at work elsewhere at {moment}"


def _last_piece(log: EventLog, work: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(rows,) the last piece of each row's job that was over when the row began; -1 where there is none."""
    order = work[np.lexsort([log["end_s"][work], log["job"][work]])]
    keys = np.rec.fromarrays([log["job"][order], ticks(log["end_s"][order])])
    asked = np.rec.fromarrays([log["job"][rows], ticks(log["start_s"][rows])])
    at = np.searchsorted(keys, asked, side="right") - 1
    found = np.r_[order, -1][at]  # at is -1 where there is none
    return np.where((found >= 0) & (log["job"][found] == log["job"][rows]), found, -1)
