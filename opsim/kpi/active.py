"""Active periods: how long a station goes on working without a break."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.outages import outage_rows
from opsim.kpi.values import by_rank, changes, mean
from opsim.log import SETUP, WORK, EventLog
from opsim.plan import Plan


@dataclass(frozen=True, slots=True)
class Periods:
    """Active periods of stations, by station and time; every array is (N,). Those of one station do not meet."""

    station: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray


def active_periods(log: EventLog, plan: Plan) -> Periods:
    """When each station was active: all of its servers at work or set up, or the station down: it could not take more.

    Waiting for a job, for room or for a worker ends a period; the next job at the same instant does not. Periods are
    whole: the window does not cut them, start and horizon of the run do.
    Source: Roser, Nakano & Tanaka 2001, A practical bottleneck detection method, Winter Simulation Conference, 949-953.
    """
    servers = np.array([s.servers for s in plan.stations])
    of_jobs = np.isin(log["kind"], (WORK, SETUP)) & (log["station"] >= 0) & (log["job"] >= 0)
    stops = outage_rows(log)
    rows = np.r_[np.flatnonzero(of_jobs), stops]
    taken = np.ones(rows.size, dtype=int)
    taken[rows.size - stops.size :] = servers[log["station"][stops]]
    station, step = np.tile(log["station"][rows], 2), np.r_[taken, -taken]
    time_s = np.r_[log["start_s"][rows], log["end_s"][rows]]
    order = np.lexsort([time_s, station])
    station, time_s, at_work = station[order], time_s[order], np.cumsum(step[order])
    settled = np.r_[changes(station, time_s)[1:], True][: order.size]
    station, time_s = station[settled], time_s[settled]
    active = at_work[settled] == servers[station]
    before = np.r_[False, active[:-1]][: active.size]
    begins = active & ~before
    return Periods(station[begins], time_s[begins], time_s[before & ~active])


def active_time(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Mean length of the active periods that reach into the window; the longest belongs to the bottleneck."""
    periods = active_periods(log, plan)
    counted = periods.end_s > plan.window_s[0]
    length_s = (periods.end_s - periods.start_s)[counted]
    for station, lengths_s in zip(plan.stations, by_rank(length_s, periods.station[counted], len(plan.stations))):
        if station.tasks:
            yield Figure("active_period_s", station.name, "", "s", mean(lengths_s))
