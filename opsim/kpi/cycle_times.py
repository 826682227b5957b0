"""How long work takes: performances of each task, and the work a job gets at each station.

Overall equipment effectiveness of each station.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import (
    by_rank,
    changes,
    elapsed_s,
    in_window,
    inside_s,
    mean,
    open_time_s,
    quantiles,
    station_hours,
)
from opsim.log import (
    BATCH,
    BREAKDOWN,
    HELD,
    LEAVING_KINDS,
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
from opsim.subjects.breakdowns.figures import outage_rows


@dataclass(frozen=True, slots=True)
class Visits:
    """Visits of jobs to stations, as far as they were worked on; every array is (V,).

    station : rank; work_s : seconds of work the job got; end_s : when the last of it ended;
    whole   : whether every performance of the visit is done
    """

    station: np.ndarray
    work_s: np.ndarray
    end_s: np.ndarray
    whole: np.ndarray


def visits(log: EventLog, plan: Plan) -> Visits:
    """Work rows, put together by visit: the n-th visit of a job to a station holds its n-th P performances there.

    P is the number of performances that one visit takes, repeats and the units of a lot included. A performance under
    way (progress below 1) belongs to the visit under way. Set-ups are no work. Of a batch only the first job has rows.
    NOTE: the log is sorted by time, so a stable sort keeps each job's rows in time.
    """
    work = np.flatnonzero((log["kind"] == WORK) & (log["job"] >= 0) & (log["station"] >= 0))
    stay = log["job"][work] * len(plan.stations) + log["station"][work]
    order = np.argsort(stay, kind="stable")
    work, stay = work[order], stay[order]
    station, done = log["station"][work], log["progress_to"][work] == 1
    needed = _performances(plan)[log["product"][work], station]
    first = changes(stay)
    done_before = np.cumsum(done) - done
    done_before -= done_before[first][np.cumsum(first) - 1]
    number, shared = done_before // needed, np.isin(station, [r for s in plan.shares for r in (s.station, s.partner)])
    if shared.any():
        coming, over = _comings(log, work, station)
        number = np.where(shared, coming, number)
    begins = changes(stay, number)
    visit, start = np.cumsum(begins) - 1, np.flatnonzero(begins)
    last = np.r_[start[1:], work.size][: start.size] - 1
    work_s = np.bincount(visit, weights=log["end_s"][work] - log["start_s"][work], minlength=start.size)
    n_done = np.bincount(visit[done], minlength=start.size)
    whole = n_done == needed[start]
    if shared.any():
        whole = np.where(shared[start], done[last] & over[last], whole)
    return Visits(station[start], work_s, log["end_s"][work[last]], whole)


def _comings(log: EventLog, work: np.ndarray, station: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(rows,) which coming to a station each row of work belongs to, and whether the job has gone on from there.

    Where two stations share work, no number of performances says when a visit is over.
    """
    job = log["job"][work]
    order = np.lexsort([work, job])
    coming = np.empty(work.size, dtype=np.int64)
    coming[order] = np.cumsum(changes(job[order], station[order]))
    _, of = np.unique(job, return_inverse=True)
    latest = np.zeros(of.max() + 1, dtype=np.int64)
    np.maximum.at(latest, of, coming)
    return coming, (coming < latest[of]) | np.isin(job, log.of(*LEAVING_KINDS)["job"])


def _performances(plan: Plan) -> np.ndarray:
    """(products, stations) performances that one visit takes; at least 1, so that it may be divided by."""
    found = np.ones((len(plan.products), len(plan.stations)), dtype=np.int64)
    batches = {batch.station for batch in plan.batches}
    for rank, station in enumerate(plan.stations):
        tasks = [plan.tasks[task] for task in station.tasks]
        for product, made in enumerate(plan.products):
            each = [task.repeat * (1 if task.per_lot or rank in batches else made.lot) for task in tasks]
            found[product, rank] = max(sum(each), 1)
    return found


def cycle_times(log: EventLog, plan: Plan) -> dict[str, np.ndarray]:
    """By station: seconds of work in each visit that ends in the window, whole ones only; nothing of other points."""
    found = visits(log, plan)
    counted = found.whole & in_window(found.end_s, plan)
    parts = by_rank(found.work_s[counted], found.station[counted], len(plan.stations))
    return {station.name: part for station, part in zip(plan.stations, parts) if station.tasks}


def task_durations(log: EventLog, plan: Plan) -> dict[str, np.ndarray]:
    """By task: seconds of performances that end in the window, whole ones only."""
    whole = np.isin(log["kind"], (WORK, SETUP)) & (log["progress_from"] == 0) & (log["progress_to"] == 1)
    rows = np.flatnonzero(whole & in_window(log["end_s"], plan) & (log["task"] >= 0))
    if any(task.team > 1 for task in plan.tasks):  # each of a team has a row of his own beside the job's
        of_team = np.array([task.team > 1 for task in plan.tasks])[log["task"][rows]]
        rows = rows[~of_team | (log["worker"][rows] >= 0)]
    parts = by_rank(log["end_s"][rows] - log["start_s"][rows], log["task"][rows], len(plan.tasks))
    repairs = {stop.task for stop in plan.stops}
    return {task.name: part for rank, (task, part) in enumerate(zip(plan.tasks, parts)) if rank not in repairs}


def durations(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Mean seconds of a performance of each task."""
    for task, seconds in task_durations(log, plan).items():
        yield figure("duration_s", task, "", mean(seconds))


def work_by_visit(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Seconds of work a job gets in a visit to each station: their mean and quantiles."""
    for station, seconds in cycle_times(log, plan).items():
        yield figure("cycle_time_s", station, "", mean(seconds))
        yield from quantiles("cycle_time_quantile_s", station, seconds)


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
        yield figure("oee", place.name, "", float(np.prod(list(factors.values()))))
        factors["speed"] = _ratio(planned_s[rank], worked_s[rank])
        factors["use"] = _ratio(worked_s[rank], available_s[rank])
        for part, value in factors.items():
            yield figure("oee_factor", place.name, part, value)


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
