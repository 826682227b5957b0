"""Laws of jobs: none comes from nowhere or vanishes, and each is in one state at a time."""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.laws.stays import Stays, untiled, words
from opsim.log import EventLog
from opsim.plan import Plan


def conserved(_log: EventLog, _plan: Plan, stays: Stays) -> Iterator[str]:
    """Every job is created once and leaves at most once, and who has not left is inside at the horizon."""
    for numbers, what in ((stays.number, "created"), (stays.left_number, "gone")):
        values, counts = np.unique(numbers, return_counts=True)
        if np.any(counts > 1):
            yield f"job {values[counts > 1][0]} is {what} more than once"
    unknown = np.setdiff1d(stays.left_number, stays.number)
    if unknown.size:
        yield f"job {unknown[0]} leaves but was never created"
    rows = stays.rows
    strangers = np.setdiff1d(rows["job"], stays.number)
    if strangers.size:
        yield f"job {strangers[0]} is worked on but was never created"
    inside_until_horizon = rows["job"][ticks(rows["end_s"]) == stays.horizon]
    staying = stays.number[(stays.leave == stays.horizon) & (stays.enter < stays.horizon)]
    missing = np.setdiff1d(np.setdiff1d(staying, stays.left_number), inside_until_horizon)
    if missing.size:
        yield f"job {missing[0]} has not left and is not inside at the horizon"


def tiled(_log: EventLog, _plan: Plan, stays: Stays) -> Iterator[str]:
    """A job's rows follow each other from its creation until it leaves."""
    yield from untiled(stays.rows, stays.rows["job"], stays.number, stays.enter, stays.leave, "job")


def integral(_log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """Jobs' rows, clipped to the window, sum to what stands between creations and leavings."""
    low, high = (int(ticks(edge)) for edge in plan.window_s)

    def clipped(times: np.ndarray) -> int:
        return np.clip(times, low, high).sum()

    spent = clipped(ticks(stays.rows["end_s"])) - clipped(ticks(stays.rows["start_s"]))
    inside = clipped(stays.leave) - clipped(stays.enter)
    if spent != inside:
        yield f"jobs' rows sum to {words(spent)} in the window, jobs inside integrate to {words(inside)}"
