"""When each job was on the floor, in whole ticks of 2^-20 s, so that equal means equal; and what laws do with rows."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.log import CREATE, JOB_KINDS, LEAVING_KINDS, EventLog


class Stays:
    """Arrivals and leavings of all jobs, by job number.

    number, enter, leave : (J,) sorted by number; who did not leave stays until the horizon
    left_number, left    : (L,) of those who left, in time
    rows                 : the rows that are states of a job
    """

    def __init__(self, log: EventLog):
        created, gone = log.of(CREATE), log.of(*LEAVING_KINDS)
        order = np.argsort(created["job"], kind="stable")
        self.number = created["job"][order]
        self.enter = ticks(created["end_s"][order])
        self.horizon = int(ticks(log.horizon_s))
        self.left_number, self.left = gone["job"], ticks(gone["end_s"])
        self.leave = np.full(self.number.size, self.horizon)
        known = np.isin(self.left_number, self.number)
        self.leave[np.searchsorted(self.number, self.left_number[known])] = self.left[known]
        self.rows = log.where(np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0))


def untiled(rows: EventLog, subject, subjects, begin, end, what: str) -> Iterator[str]:
    """Rows of each subject must cover [begin, end) of it, one after the other. ``subjects`` is sorted."""
    order = np.lexsort([rows["end_s"], rows["start_s"], subject])
    who, start, stop = subject[order], ticks(rows["start_s"])[order], ticks(rows["end_s"])[order]
    same = who[1:] == who[:-1]
    apart = same & (start[1:] != stop[:-1])
    if np.any(apart):
        i = int(np.flatnonzero(apart)[0])
        found = "overlap" if start[i + 1] < stop[i] else "gap"
        yield f"{what} {who[i]}: {found} between rows ending {words(stop[i])} and starting {words(start[i + 1])}"
    first = np.flatnonzero(np.r_[True, ~same]) if who.size else np.array([], dtype=int)
    last = np.r_[first[1:], who.size] - 1 if who.size else first
    from_tick, to_tick = begin.copy(), begin.copy()
    at = np.searchsorted(subjects, who[first])
    from_tick[at], to_tick[at] = start[first], stop[last]
    wrong = np.flatnonzero((from_tick != begin) | (to_tick != end))
    if wrong.size:
        i = int(wrong[0])
        yield (
            f"{what} {subjects[i]}: rows cover {words(from_tick[i])} to {words(to_tick[i])}, "
            f"its stay is {words(begin[i])} to {words(end[i])}"
        )


def peak(rows: EventLog, units: np.ndarray | int = 1) -> int:
    """Most units of rows open at once; a row that ends makes room before one that starts then.

    units : (rows,) how much each row counts
    """
    times = np.concatenate([ticks(rows["end_s"]), ticks(rows["start_s"])])
    counted = np.broadcast_to(units, len(rows))
    steps = np.concatenate([-counted, counted])
    order = np.lexsort([steps, times])
    return int(max(np.cumsum(steps[order]), default=0))


def words(tick: int) -> str:
    """A time in ticks as people read it."""
    return f"{tick / 2**20:g} s"
