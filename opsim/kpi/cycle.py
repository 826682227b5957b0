"""How long work takes: performances of each task, and the work a job gets at each station."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import by_rank, changes, in_window, mean, quantiles
from opsim.log import LEAVING_KINDS, SETUP, WORK, EventLog
from opsim.plan import Plan


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
        yield Figure("duration_s", task, "", "s", mean(seconds))


def work_by_visit(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Seconds of work a job gets in a visit to each station: their mean and quantiles."""
    for station, seconds in cycle_times(log, plan).items():
        yield Figure("cycle_time_s", station, "", "s", mean(seconds))
        yield from quantiles("cycle_time_quantile_s", station, "s", seconds)
