"""The law of outages: a station that is down does nothing, and is down for one reason at a time."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.stays import Stays, words
from opsim.log import DOWN, REPAIR, SETUP, WORK, EventLog
from opsim.plan import Plan


def outages(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """Rows of a station's outages do not overlap, and no performance or set-up there overlaps with one of them."""
    down = log.where(np.isin(log["kind"], (DOWN, REPAIR)) & (log["job"] < 0) & (log["worker"] < 0))
    if not len(down):
        return
    at_work = log.where(np.isin(log["kind"], (WORK, SETUP)) & (log["station"] >= 0))
    for rank in np.unique(down["station"]):
        name = plan.stations[rank].name
        start, end = _sorted(down.where(down["station"] == rank))
        twice = np.flatnonzero(start[1:] < end[:-1])
        if twice.size:
            yield f"station {name}: goes down at {words(start[twice[0] + 1])}, while it is down already"
        begins, ends = _sorted(at_work.where(at_work["station"] == rank))
        before = np.searchsorted(start, ends, side="left") - 1  # the last outage that began before the work ended
        meets = np.flatnonzero((before >= 0) & (end[before] > begins))
        if meets.size:
            outage = before[meets[0]]
            yield f"station {name}: work goes on at {words(max(start[outage], begins[meets[0]]))}, while it is down"


def _sorted(rows: EventLog) -> tuple[np.ndarray, np.ndarray]:
    """(rows,) starts and ends in ticks, by start."""
    order = np.argsort(rows["start_s"], kind="stable")
    return ticks(rows["start_s"][order]), ticks(rows["end_s"][order])
