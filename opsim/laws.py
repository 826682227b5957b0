"""What must be true of every event log, checked after every run: nothing lost, nobody in two places, no gap.

All sums are over whole ticks of 2^-20 s, so that equal means equal.
"""

from collections.abc import Iterator

import numpy as np

from opsim.clock import ticks
from opsim.log import BLOCKED, CREATE, FINISH, HELD, JOB_KINDS, LOST, QUEUE, WORK, WORKER_KINDS, EventLog
from opsim.plan import Plan

CHECKS = (
    "every job created is finished, lost or inside",
    "a worker is in exactly one state at any time",
    "a job's rows tile its stay without gap",
    "time of jobs' rows in the window equals the integral of jobs inside",
    "no station holds more jobs than it has servers and buffer",
)


class BrokenLog(AssertionError):
    """An event log that contradicts itself; the message names the first contradiction found."""


def audit(log: EventLog, plan: Plan) -> tuple[str, ...]:
    """Check a log against the laws of ``CHECKS``; returns them. Raises BrokenLog, naming what is wrong."""
    jobs = _Jobs(log)
    for law in (_conserved, _one_state_a_worker, _tiled, _integral, _capacities):
        for complaint in law(log, plan, jobs):
            raise BrokenLog(f"replication {log.replication}: {complaint}")
    return CHECKS


class _Jobs:
    """Arrivals and leavings of all jobs, in ticks, by job number."""

    def __init__(self, log: EventLog):
        created, left = log.of(CREATE), log.of(FINISH, LOST)
        order = np.argsort(created["job"], kind="stable")
        self.number = created["job"][order]
        self.enter = ticks(created["end_s"][order])
        self.horizon = int(ticks(log.horizon_s))
        self.left_number, self.left = left["job"], ticks(left["end_s"])
        self.leave = np.full(self.number.size, self.horizon)
        known = np.isin(self.left_number, self.number)
        self.leave[np.searchsorted(self.number, self.left_number[known])] = self.left[known]


def _conserved(log: EventLog, _plan: Plan, jobs: _Jobs) -> Iterator[str]:
    for numbers, what in ((jobs.number, "created"), (jobs.left_number, "gone")):
        values, counts = np.unique(numbers, return_counts=True)
        if np.any(counts > 1):
            yield f"job {values[counts > 1][0]} is {what} more than once"
    unknown = np.setdiff1d(jobs.left_number, jobs.number)
    if unknown.size:
        yield f"job {unknown[0]} leaves but was never created"
    rows = log.where(np.isin(log["kind"], JOB_KINDS))
    strangers = np.setdiff1d(rows["job"], jobs.number)
    if strangers.size:
        yield f"job {strangers[0]} is worked on but was never created"
    inside_until_horizon = rows["job"][ticks(rows["end_s"]) == jobs.horizon]
    staying = jobs.number[(jobs.leave == jobs.horizon) & (jobs.enter < jobs.horizon)]
    missing = np.setdiff1d(np.setdiff1d(staying, jobs.left_number), inside_until_horizon)
    if missing.size:
        yield f"job {missing[0]} is neither finished, lost nor inside at the horizon"


def _one_state_a_worker(log: EventLog, plan: Plan, jobs: _Jobs) -> Iterator[str]:
    rows = log.where(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    everyone = np.arange(len(plan.workers))
    yield from _tiling(
        rows, rows["worker"], everyone, np.zeros_like(everyone), np.full_like(everyone, jobs.horizon), "worker"
    )


def _tiled(log: EventLog, _plan: Plan, jobs: _Jobs) -> Iterator[str]:
    rows = log.where(np.isin(log["kind"], JOB_KINDS))
    yield from _tiling(rows, rows["job"], jobs.number, jobs.enter, jobs.leave, "job")


def _tiling(rows: EventLog, subject, subjects, begin, end, what: str) -> Iterator[str]:
    """Rows of each subject must cover [begin, end) of it, one after the other. ``subjects`` is sorted."""
    order = np.lexsort([rows["end_s"], rows["start_s"], subject])
    who, start, stop = subject[order], ticks(rows["start_s"])[order], ticks(rows["end_s"])[order]
    same = who[1:] == who[:-1]
    apart = same & (start[1:] != stop[:-1])
    if np.any(apart):
        i = int(np.flatnonzero(apart)[0])
        found = "overlap" if start[i + 1] < stop[i] else "gap"
        yield f"{what} {who[i]}: {found} between rows ending {_s(stop[i])} and starting {_s(start[i + 1])}"
    first = np.flatnonzero(np.r_[True, ~same]) if who.size else np.array([], dtype=int)
    last = np.r_[first[1:], who.size] - 1 if who.size else first
    from_tick, to_tick = begin.copy(), begin.copy()
    at = np.searchsorted(subjects, who[first])
    from_tick[at], to_tick[at] = start[first], stop[last]
    wrong = np.flatnonzero((from_tick != begin) | (to_tick != end))
    if wrong.size:
        i = int(wrong[0])
        yield (
            f"{what} {subjects[i]}: rows cover {_s(from_tick[i])} to {_s(to_tick[i])}, "
            f"its stay is {_s(begin[i])} to {_s(end[i])}"
        )


def _integral(log: EventLog, plan: Plan, jobs: _Jobs) -> Iterator[str]:
    low, high = (int(ticks(edge)) for edge in plan.window_s)
    rows = log.where(np.isin(log["kind"], JOB_KINDS))
    spent = _clip(ticks(rows["end_s"]), low, high).sum() - _clip(ticks(rows["start_s"]), low, high).sum()
    inside = _clip(jobs.leave, low, high).sum() - _clip(jobs.enter, low, high).sum()
    if spent != inside:
        yield f"jobs' rows sum to {_s(spent)} in the window, jobs inside integrate to {_s(inside)}"


def _capacities(log: EventLog, plan: Plan, _jobs: _Jobs) -> Iterator[str]:
    rows = log.where(np.isin(log["kind"], JOB_KINDS))
    for rank, station in enumerate(plan.stations):
        here = rows["station"] == rank
        on_server = here & np.isin(rows["kind"], (WORK, BLOCKED, HELD))
        for mask, most, what in (
            (on_server, station.servers, "servers"),
            (here & (rows["kind"] == QUEUE), station.buffer, "places in its buffer"),
        ):
            peak = _peak(rows.where(mask))
            if peak > most:
                yield f"station {station.name}: {peak} jobs at once on {most:g} {what}"


def _peak(rows: EventLog) -> int:
    """Most rows open at once; a row that ends makes room before one that starts then."""
    times = np.concatenate([ticks(rows["end_s"]), ticks(rows["start_s"])])
    steps = np.repeat([-1, 1], len(rows))
    order = np.lexsort([steps, times])
    return int(max(np.cumsum(steps[order]), default=0))


def _clip(values: np.ndarray, low: int, high: int) -> np.ndarray:
    return np.clip(values, low, high)


def _s(value: int) -> str:
    return f"{value / 2**20:g} s"
