"""How many there were over the clock: levels that go up and down in steps, and fewer of them for a picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from opsim.log import CREATE, JOB_KINDS, LEAVING_KINDS, EventLog
from opsim.plan import Plan


@dataclass(frozen=True, eq=False)
class Steps:
    """``level`` (N,) from ``at_s`` (N,) on, until the next; the last one until ``end_s``. The first begins at 0."""

    at_s: np.ndarray
    level: np.ndarray
    end_s: float

    @property
    def seconds(self) -> np.ndarray:
        """(N,) how long each level lasted."""
        return np.diff(self.at_s, append=self.end_s)

    def within(self, low_s: float, high_s: float) -> Steps:
        """The part of them between two times, which becomes its own clock's beginning and end."""
        first = max(0, int(np.searchsorted(self.at_s, low_s, side="right")) - 1)
        last = int(np.searchsorted(self.at_s, high_s, side="left"))
        at_s = np.maximum(self.at_s[first:last], low_s)
        return Steps(at_s, self.level[first:last], high_s)

    @property
    def mean(self) -> float:
        """Over the time they last."""
        seconds = self.seconds
        return float((self.level * seconds).sum() / seconds.sum()) if seconds.sum() > 0 else float("nan")


def steps_of(up_s: np.ndarray, down_s: np.ndarray, end_s: float) -> Steps:
    """The level that rises by one at some instants and falls by one at others; what happens at one instant is one
    step, and one that changes nothing is none."""
    times = np.concatenate([[0.0], up_s, down_s])
    by = np.concatenate([[0], np.ones(up_s.size), -np.ones(down_s.size)]).astype(np.int64)
    order = np.argsort(times, kind="stable")
    times, level = times[order], np.cumsum(by[order])
    settled = np.r_[times[1:] != times[:-1], True]
    times, level = times[settled], level[settled]
    kept = np.r_[True, level[1:] != level[:-1]] & (times < end_s)
    kept[:1] = True
    return Steps(times[kept], level[kept], end_s)


def jobs_inside(log: EventLog) -> Steps:
    """Jobs on the floor: created, and not left."""
    left = np.isin(log["kind"], LEAVING_KINDS)
    return steps_of(log["end_s"][log["kind"] == CREATE], log["end_s"][left], log.horizon_s)


def jobs_at(log: EventLog, n_points: int) -> list[Steps]:
    """By point of the flow: the jobs there, waiting, in work or kept. With those that are nowhere (before a gate, on a
    vehicle) they are ``jobs_inside``."""
    rows = np.flatnonzero((log["job"] >= 0) & (log["station"] >= 0) & np.isin(log["kind"], JOB_KINDS))
    rows = rows[np.argsort(log["station"][rows], kind="stable")]
    ends = np.searchsorted(log["station"][rows], np.arange(n_points + 1))
    parts = [rows[first:last] for first, last in pairwise(ends.tolist())]
    return [steps_of(log["start_s"][part], log["end_s"][part], log.horizon_s) for part in parts]


def thinned(steps: Steps, most: int) -> tuple[np.ndarray, np.ndarray]:
    """(times, levels) of a line in steps that has at most ``most`` points and ends where the clock does; of many, the
    first, the lowest and the highest level of each of even stretches of time, so that no peak is lost."""
    at_s, level = np.r_[steps.at_s, steps.end_s], np.r_[steps.level, steps.level[-1]]
    if at_s.size <= most:
        return at_s, level
    edges_s = np.linspace(0.0, steps.end_s, most // 3 + 1)
    begins = np.searchsorted(at_s, edges_s[:-1])
    begins = np.unique(begins[begins < at_s.size])
    order = np.lexsort([level, np.searchsorted(begins, np.arange(at_s.size), side="right")])
    lasts = np.r_[begins[1:], at_s.size] - 1
    kept = np.unique(np.r_[0, begins, order[begins], order[lasts], at_s.size - 1])
    return at_s[kept], level[kept]


def room_of(plan: Plan, rank: int) -> float:
    """Jobs that fit at a point, those kept behind its servers among them."""
    station = plan.stations[rank]
    return station.capacity + station.buffer_after


def share_full(steps: Steps, room: float, window_s: Sequence[float]) -> float:
    """The share of a window in which there is no room left."""
    counted = steps.within(*window_s)
    seconds = counted.seconds
    return (
        float(seconds[counted.level >= room].sum() / seconds.sum()) if np.isfinite(room) and seconds.sum() > 0 else 0.0
    )
