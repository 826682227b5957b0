"""Overall equipment effectiveness of each station."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.cycle import visits
from opsim.kpi.figure import Figure
from opsim.kpi.open_hours import elapsed_s, open_time_s, station_hours
from opsim.kpi.outages import outage_rows
from opsim.kpi.values import in_window, inside_s
from opsim.log import (
    BATCH,
    BREAKDOWN,
    HELD,
    MAINTENANCE,
    REWORK,
    SCRAP,
    SENT_ON,
    SETUP,
    UNFINISHED,
    WORK,
    EventLog,
)
from opsim.plan import Plan


def oee(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """OEE = availability x performance x quality, per server of a station over the window; each factor beside it.

    Planned time is that of the window in which the station is open, without planned maintenance.
    availability : the share of planned time in which the station is neither down by a breakdown nor being set up
    performance  : seconds the work done should take by the tasks' mean durations / seconds available. It is speed
                   (should take / took) times use (took / available), so blocking, starving and waiting lower it
    quality      : the share of the operations of the window after which the job was neither scrap nor sent to rework,
                   and that were not left unfinished on a paced line
    Source: Nakajima 1988, Introduction to TPM, Productivity Press (performance = operating speed rate x net operating
    rate; idling and minor stoppages are losses of performance, breakdowns and set-ups of availability). Minor stops
    that a scenario models as breakdowns are losses of availability here.
    """
    rows = np.flatnonzero((log["kind"] == WORK) & (log["station"] >= 0) & (log["task"] >= 0) & (log["job"] >= 0))
    took_s = inside_s(log, rows, plan)
    part_inside = took_s / (log["end_s"][rows] - log["start_s"][rows])
    done = (log["progress_to"][rows] - log["progress_from"][rows]) * part_inside
    mean_s = np.array([task.model.mean_duration_s() for task in plan.tasks])[log["task"][rows]]
    planned_s, worked_s = (_by_station(log, plan, rows, weights) for weights in (done * mean_s, took_s))
    servers = np.array([station.servers for station in plan.stations])
    planned_time_s, available_s = _times(log, plan, servers)
    quality = _quality(log, plan)
    for rank, place in enumerate(plan.stations):
        if not place.tasks:
            continue
        factors = {"availability": _ratio(available_s[rank], planned_time_s[rank], 1.0)}
        factors["performance"] = _ratio(planned_s[rank], available_s[rank])
        factors["quality"] = quality[rank]
        yield Figure("oee", place.name, "", "share", float(np.prod(list(factors.values()))))
        factors["speed"] = _ratio(planned_s[rank], worked_s[rank])
        factors["use"] = _ratio(worked_s[rank], available_s[rank])
        for part, value in factors.items():
            yield Figure("oee_factor", place.name, part, "share", value)


def _times(log: EventLog, plan: Plan, servers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(stations,) seconds of servers in the window that are planned for work, and those of them it can be done in."""
    stops = outage_rows(log)
    down_s = _open_s(log, plan, stops) * servers[log["station"][stops]]
    maintained = log["cause"][stops] == MAINTENANCE
    setups = np.flatnonzero((log["kind"] == SETUP) & (log["station"] >= 0) & (log["job"] >= 0))
    open_s = [open_time_s(plan, station_hours(plan, rank)) for rank in range(len(plan.stations))]
    planned_s = np.array(open_s) * servers - _by_station(log, plan, stops[maintained], down_s[maintained])
    lost_s = _by_station(log, plan, stops[~maintained], down_s[~maintained])
    return planned_s, planned_s - lost_s - _by_station(log, plan, setups, inside_s(log, setups, plan))


def _open_s(log: EventLog, plan: Plan, rows: np.ndarray) -> np.ndarray:
    """(rows,) seconds in the window of some rows while their station is open."""
    seconds = inside_s(log, rows, plan)
    for rank, place in enumerate(plan.stations):
        here = log["station"][rows] == rank
        if place.open_s is not None and here.any():
            edges_s = (np.clip(log[edge][rows[here]], *plan.window_s) for edge in ("start_s", "end_s"))
            begin_s, end_s = (elapsed_s(place.open_s, at_s) for at_s in edges_s)
            seconds[here] = end_s - begin_s
    return seconds


def _quality(log: EventLog, plan: Plan) -> np.ndarray:
    """(stations,) share of the operations of the window that ended well; 1 where there was none."""
    wrong = np.isin(log["kind"], (SCRAP, REWORK, SENT_ON)) & (log["station"] >= 0) & in_window(log["end_s"], plan)
    found = _once_each(log, np.flatnonzero(wrong))
    halfway = found[np.isin(log["cause"][found], (BREAKDOWN, UNFINISHED))]  # these never became whole visits
    n_wrong, n_halfway = (_by_station(log, plan, rows, np.ones(rows.size)) for rows in (found, halfway))
    whole = visits(log, plan)
    counted = whole.whole & in_window(whole.end_s, plan)
    with_others = (log["kind"] == HELD) & (log["cause"] == BATCH) & in_window(log["end_s"], plan)
    members = np.flatnonzero(with_others & (log["station"] >= 0))  # only the first of a batch has visits
    n_done = np.bincount(whole.station[counted], minlength=len(plan.stations)) + n_halfway
    n_done = n_done + _by_station(log, plan, members, np.ones(members.size))
    return 1.0 - np.divide(n_wrong, n_done, out=np.zeros(n_done.size), where=n_done > 0)


def _once_each(log: EventLog, rows: np.ndarray) -> np.ndarray:
    """The rows of what went wrong, without those of jobs that were turned down where they had been left unfinished."""
    sent = log["kind"][rows] == SENT_ON
    if not sent.any():
        return rows
    pair = log["job"][rows] * np.int64(log["station"].max() + 1) + log["station"][rows]
    return rows[sent | ~np.isin(pair, pair[sent])]


def _by_station(log: EventLog, plan: Plan, rows: np.ndarray, weights: np.ndarray) -> np.ndarray:
    return np.bincount(log["station"][rows], weights=weights, minlength=len(plan.stations))


def _ratio(part: float, whole: float, otherwise: float = np.nan) -> float:
    return part / whole if whole > 0 else otherwise
