"""What figures share: the window, values by subject, means and quantiles.

Scheduled hours in the window: when the floor (``scheduled``), a station or a worker is meant to be there.

The floor is open while at least one station on a route may work: it is open and, where its tasks need people, enough
of those who can work there are on shift. Hours of sources do not count.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.log import CREATE, EventLog
from opsim.plan import Plan
from opsim.subjects.shifts.hours import scheduled
from opsim.subjects.shifts.plan import Spans, at_least, both, total_s, without

SECONDS_PER_HOUR = 3600.0
QUANTILES = {"p10": 0.1, "median": 0.5, "p90": 0.9, "p95": 0.95}


def window_length_s(plan: Plan) -> float:
    """Seconds from the end of the warm-up to the horizon."""
    low, high = plan.window_s
    return high - low


def in_window(times_s: np.ndarray, plan: Plan) -> np.ndarray:
    """(n,) whether each instant lies in the window; the horizon itself does not."""
    low, high = plan.window_s
    return (times_s >= low) & (times_s < high)


def inside_s(log: EventLog, rows: np.ndarray, plan: Plan) -> np.ndarray:
    """(n,) seconds in the window of the rows with some numbers."""
    low, high = plan.window_s
    return np.maximum(np.minimum(log["end_s"][rows], high) - np.maximum(log["start_s"][rows], low), 0.0)


def units_each(plan: Plan) -> np.ndarray:
    """(products,) units in a job of each product: those of its lot."""
    return np.array([product.lot for product in plan.products])


def created_s(log: EventLog, jobs: np.ndarray) -> np.ndarray:
    """(n,) when each of some jobs came onto the floor. NOTE: numbers of pieces have gaps, so they are looked up."""
    created = np.flatnonzero(log["kind"] == CREATE)
    order = created[np.argsort(log["job"][created], kind="stable")]
    return log["end_s"][order[np.searchsorted(log["job"][order], jobs)]]


def by_rank(values: np.ndarray, rank: np.ndarray, n: int) -> list[np.ndarray]:
    """The values of each of n subjects, in their order; rank: (rows,) whose value each is, 0 to n - 1."""
    order = np.argsort(rank, kind="stable")
    return np.split(values[order], np.searchsorted(rank[order], np.arange(1, n)))


def changes(*columns: np.ndarray) -> np.ndarray:
    """(rows,) True where any of some columns differs from the row before; the first row differs from nothing."""
    changed = np.zeros(columns[0].size, dtype=bool)
    for column in columns:
        changed[1:] |= column[1:] != column[:-1]
    changed[:1] = True
    return changed


def mean(values: np.ndarray) -> float:
    """The mean, or nan where there is nothing to average."""
    return float(values.mean()) if values.size else float("nan")


def quantiles(kpi: str, subject: str, values: np.ndarray) -> Iterator[Figure]:
    """A figure for each of ``QUANTILES``, linear between order statistics; nan where there is no value.

    Source: Hyndman & Fan 1996, Sample quantiles in statistical packages, The American Statistician 50(4), definition 7.
    """
    found = np.quantile(values, list(QUANTILES.values())) if values.size else np.full(len(QUANTILES), np.nan)
    for part, value in zip(QUANTILES, found):
        yield figure(kpi, subject, part, float(value))


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


def any_s(log: EventLog, plan: Plan, rows: np.ndarray) -> float:
    """Seconds of the window in which any of some rows is open."""
    order = rows[np.argsort(log["start_s"][rows], kind="stable")]
    start_s, end_s = (np.clip(log[edge][order], *plan.window_s) for edge in ("start_s", "end_s"))
    covered_s = np.maximum.accumulate(np.r_[plan.window_s[0], end_s])[:-1]
    return float(np.maximum(end_s - np.maximum(start_s, covered_s), 0.0).sum())
