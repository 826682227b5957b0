"""Scheduled hours: when a floor, a station or a worker is meant to be there, within the window."""

from __future__ import annotations

import numpy as np

from opsim.kpi.values import SECONDS_PER_HOUR
from opsim.plan import Plan
from opsim.plan.hours.spans import Spans, at_least, both, either, total_s, without


def has_hours(plan: Plan) -> bool:
    """Whether anything or anybody of a plan keeps hours."""
    return bool(_of_things(plan)) or any(worker.duties is not None for worker in plan.workers)


def scheduled(plan: Plan) -> Spans:
    """When the floor is scheduled to be open, from 0 to the horizon.

    Whenever a station or a source that keeps hours is open; where none does and every worker has shifts, whenever one
    of them is on shift; else always.
    """
    found = _of_things(plan)
    shifts = [worker.duties for worker in plan.workers if worker.duties is not None]
    if not found and shifts and len(shifts) == len(plan.workers):
        found = [tuple((one.start_s, one.end_s) for one in duties) for duties in shifts]
    return either(*found) if found else ((0.0, plan.horizon_s),)


def _of_things(plan: Plan) -> list[Spans]:
    """The hours of the stations and the sources that keep some."""
    stations = [station.open_s for station in plan.stations if station.open_s is not None]
    return stations + [source.open_s for source in plan.sources if source.open_s is not None]


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


def elapsed_s(spans: Spans, at_s: np.ndarray) -> np.ndarray:
    """(n,) seconds of some times that were over at some instants."""
    edges_s = np.ravel(np.array(spans).reshape(-1, 2))
    until_s = np.cumsum(np.diff(edges_s, prepend=edges_s[:1]) * (np.arange(edges_s.size) % 2))
    return np.interp(at_s, edges_s, until_s) if edges_s.size else np.zeros(np.shape(at_s))
