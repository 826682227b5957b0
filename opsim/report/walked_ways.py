"""Who walked between which two places, how often and how far, in the window of one replication."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.kpi.values import SECONDS_PER_HOUR, in_window, inside_s, window_length_s
from opsim.log import WALK, EventLog
from opsim.plan import Plan
from opsim.walks import on_grid_each, ways_m

Pair = tuple[int, int, float, float]
"""(place, place, trips an hour, metres an hour)"""


@dataclass(frozen=True)
class WalkedWays:
    """A row for each worker and pair of places, both ways together, (n,) each.

    worker, low, high : ranks; low < high, or the same where somebody walks along with a moving line
    trips_per_h : those that end in the window, as ``trips_per_h`` of the figures counts them; metres_per_h : as
        ``walked_m``; both in an hour of the window
    """

    worker: np.ndarray
    low: np.ndarray
    high: np.ndarray
    trips_per_h: np.ndarray
    metres_per_h: np.ndarray

    def where(self, mask: np.ndarray) -> WalkedWays:
        """Some of the rows."""
        return WalkedWays(*(column[mask] for column in vars(self).values()))

    def by_pair(self) -> list[Pair]:
        """All workers together, the most metres first; ways of no length are none."""
        apart = self.where(self.low != self.high)
        (low, high), which = _groups(apart.low, apart.high)
        trips = np.bincount(which, weights=apart.trips_per_h, minlength=low.size)
        metres = np.bincount(which, weights=apart.metres_per_h, minlength=low.size)
        found: list[Pair] = list(zip(low.tolist(), high.tolist(), trips.tolist(), metres.tolist()))
        return sorted(found, key=lambda one: (-one[3], -one[2], one[0], one[1]))

    def by_worker(self, n: int) -> np.ndarray:
        """(n,) metres an hour of each worker."""
        return np.bincount(self.worker, weights=self.metres_per_h, minlength=n)

    def shares(self, low: int, high: int) -> Iterator[tuple[int, float]]:
        """(worker, share of the trips between two places), the largest first."""
        own = self.where((self.low == low) & (self.high == high))
        total = float(own.trips_per_h.sum())
        for at in np.argsort(-own.trips_per_h, kind="stable").tolist():
            yield int(own.worker[at]), float(own.trips_per_h[at] / total) if total else 0.0


def walked_ways(log: EventLog, plan: Plan) -> WalkedWays:
    """Of the rows of one replication."""
    rows = np.flatnonzero((log["kind"] == WALK) & (log["worker"] >= 0))
    worker, start, end = (log[name][rows].astype(np.int64) for name in ("worker", "place_from", "place_to"))
    speed = np.array([person.walk_m_per_s for person in plan.workers])[worker]
    way_m = ways_m(log, plan, rows, speed)
    metres = way_m * np.minimum(1.0, inside_s(log, rows, plan) / on_grid_each(way_m / speed))
    ended = in_window(log["end_s"][rows], plan) & (start != end)
    (who, low, high), which = _groups(worker, np.minimum(start, end), np.maximum(start, end))
    hours, n = window_length_s(plan) / SECONDS_PER_HOUR, who.size
    trips = np.bincount(which, weights=ended, minlength=n) / hours
    metres_per_h = np.bincount(which, weights=metres, minlength=n) / hours
    some = (trips > 0) | (metres_per_h > 0)
    return WalkedWays(who[some], low[some], high[some], trips[some], metres_per_h[some])


def _groups(*columns: np.ndarray) -> tuple[list[np.ndarray], np.ndarray]:
    """(columns of what is different, in order; which of it each row is). columns : (R,) numbers from 0"""
    sizes = tuple(int(column.max(initial=0)) + 1 for column in columns)
    keys, which = np.unique(np.ravel_multi_index(columns, sizes), return_inverse=True)  # one number each: quick to sort
    return list(np.unravel_index(keys, sizes)), which
