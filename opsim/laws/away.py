"""The law of jobs that wait for one worker: he is away, or on his way, as long as they wait for him."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.stays import Stays, words
from opsim.log import AWAY, HELD, SETUP, WAIT, WORK, EventLog
from opsim.plan import Plan


def away(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """A job waits for its worker only where its last piece was his and left something, and until he is there again.

    Where he is back and its station stands, or its tools are gone, it waits for these, and is anybody's then.
    """
    rows = np.flatnonzero((log["kind"] == HELD) & (log["cause"] == AWAY) & (log["job"] >= 0))
    if not rows.size:
        return
    work = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] >= 0))
    last = _last_piece(log, work[log["job"][work] >= 0], rows)
    for row in rows[(last < 0) | (log["progress_to"][last] == 1.0)][:1]:
        yield f"job {log['job'][row]}: waits for a worker at {log['start_s'][row]:g} s, and none has left work on it"
        return
    there = np.flatnonzero(np.isin(log["kind"], (WORK, SETUP, WAIT)))
    for worker in np.unique(log["worker"][last]):
        own = there[log["worker"][there] == worker]
        own = own[np.argsort(log["start_s"][own], kind="stable")]
        waits = rows[log["worker"][last] == worker]
        first = np.searchsorted(ticks(log["end_s"][own]), ticks(log["start_s"][waits]), side="right")
        begins = np.r_[ticks(log["start_s"][own]), np.iinfo(np.int64).max][first]
        for at in np.flatnonzero(begins < ticks(log["end_s"][waits]))[:1]:
            of, moment = f"job {log['job'][waits[at]]}", words(max(begins[at], ticks(log["start_s"][waits[at]])))
            does = "is there, and idle," if log["kind"][own[first[at]]] == WAIT else "is at work elsewhere"
            yield f"{of}: waits for {plan.workers[worker].name}, who {does} at {moment}"


def _last_piece(log: EventLog, work: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(rows,) the last piece of each row's job that was over when the row began; -1 where there is none."""
    order = work[np.lexsort([log["end_s"][work], log["job"][work]])]
    keys = np.rec.fromarrays([log["job"][order], ticks(log["end_s"][order])])
    asked = np.rec.fromarrays([log["job"][rows], ticks(log["start_s"][rows])])
    at = np.searchsorted(keys, asked, side="right") - 1
    found = np.r_[order, -1][at]  # at is -1 where there is none
    return np.where((found >= 0) & (log["job"][found] == log["job"][rows]), found, -1)
