"""How long work takes: performances of each task, and the work a job gets at each station."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.flow import mean
from opsim.log import BLOCKED, JOB_KINDS, QUEUE, WORK, EventLog
from opsim.plan import Plan


def task_durations(log: EventLog, plan: Plan) -> dict[str, np.ndarray]:
    """By task: seconds of performances that end in the window, whole ones only."""
    low, high = plan.window_s
    work = log.of(WORK)
    whole = (work["progress_from"] == 0) & (work["progress_to"] == 1)
    rows = work.where(whole & (work["end_s"] >= low) & (work["end_s"] < high))
    return {task.name: rows.duration_s[rows["task"] == rank] for rank, task in enumerate(plan.tasks)}


def cycle_times(log: EventLog, plan: Plan) -> dict[str, np.ndarray]:
    """By station: seconds of work in each visit of a job that ended its work there in the window."""
    rows = log.where(np.isin(log["kind"], JOB_KINDS))
    rows = rows.where(np.lexsort([rows["end_s"], rows["start_s"], rows["job"]]))
    visit = _visit_numbers(rows)
    work = rows["kind"] == WORK
    n_visits = int(visit[-1]) + 1 if visit.size else 0
    seconds = np.bincount(visit[work], weights=rows.duration_s[work], minlength=n_visits)
    unfinished = np.bincount(visit[work], weights=rows["progress_to"][work] < 1, minlength=n_visits) > 0
    ends = np.zeros(n_visits)
    np.maximum.at(ends, visit[work], rows["end_s"][work])
    station = np.zeros(n_visits, dtype=int)
    station[visit] = rows["station"]
    low, high = plan.window_s
    counted = (seconds > 0) & ~unfinished & (ends >= low) & (ends < high)
    return {s.name: seconds[counted & (station == rank)] for rank, s in enumerate(plan.stations)}


def mean_durations(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Mean seconds of a performance of each task."""
    for task, seconds in task_durations(log, plan).items():
        yield Figure("duration_s", task, "", "s", mean(seconds))


def mean_cycle_times(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Mean seconds of work a job gets at each station."""
    for station, seconds in cycle_times(log, plan).items():
        yield Figure("cycle_time_s", station, "", "s", mean(seconds))


def _visit_numbers(rows: EventLog) -> np.ndarray:
    """(rows,) a number for each stay of a job at a station, rows being sorted by job and time."""
    job, station, kind = rows["job"], rows["station"], rows["kind"]
    begins = (job[1:] != job[:-1]) | (station[1:] != station[:-1]) | (kind[:-1] == BLOCKED) | (kind[1:] == QUEUE)
    return np.cumsum(np.r_[0, begins]) if job.size else np.zeros(0, dtype=int)
