"""Scheduled hours in the window: when the floor (``scheduled``), a station or a worker is meant to be there.

The floor is open while at least one station on a route may work: it is open and, where its tasks need people, enough
of those who can work there are on shift. Hours of sources do not count.
"""

from __future__ import annotations

import numpy as np

from opsim.kpi.values import SECONDS_PER_HOUR
from opsim.plan import Plan
from opsim.plan.hours.scheduled import scheduled
from opsim.plan.hours.spans import Spans, at_least, both, total_s, without


def open_hours(plan: Plan) -> float:
    """Scheduled hours in the window."""
    return open_time_s(plan, scheduled(plan)) / SECONDS_PER_HOUR


def open_time_s(plan: Plan, spans: Spans) -> float:
    """Seconds of some times that lie in the window."""
    return total_s(both(spans, (plan.window_s,)))


def station_hours(plan: Plan, station: int) -> Spans:
    """When a station is open."""
    open_s = plan.stations[station].open_s
    return ((0.0, plan.horizon_s),) if open_s is None else open_s


def closed_hours(plan: Plan, station: int) -> Spans:
    """When a station is closed by its calendar."""
    return without(((0.0, plan.horizon_s),), station_hours(plan, station))


def duty_hours(plan: Plan, worker: int) -> Spans:
    """When a worker is meant to be there; those of shifts that follow one another at once are one."""
    duties = plan.workers[worker].duties
    return ((0.0, plan.horizon_s),) if duties is None else at_least(1, [((one.start_s, one.end_s),) for one in duties])


def is_in(spans: Spans, at_s: np.ndarray) -> np.ndarray:
    """(n,) whether some instants are in some times, their ends included and their beginnings not."""
    return np.searchsorted(np.ravel(np.array(spans)), at_s) % 2 == 1


def elapsed_s(spans: Spans, at_s: np.ndarray) -> np.ndarray:
    """(n,) seconds of some times that were over at some instants."""
    edges_s = np.ravel(np.array(spans).reshape(-1, 2))
    until_s = np.cumsum(np.diff(edges_s, prepend=edges_s[:1]) * (np.arange(edges_s.size) % 2))
    return np.interp(at_s, edges_s, until_s) if edges_s.size else np.zeros(np.shape(at_s))
