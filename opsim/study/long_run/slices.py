"""A run cut into slices of time, and its jobs one after another: what batch means are made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from opsim.kpi.values import created_s
from opsim.log import FINISH, QUEUE, STOCK, WORK, EventLog
from opsim.study.warm_up import SLICES, at_once, finished_per_h, jobs_inside

FINE = 4 * SLICES
DAY_S = 86_400.0
WEEK_S = 7 * DAY_S
FEWEST_CYCLES = 10
"""Whole days or weeks below which a run is cut into equal slices instead."""
MOST_JOBS = 4000
"""Values kept of each replication's jobs: of more, neighbours are put together."""


def edges_of(horizon_s: float, keeps_hours: bool) -> np.ndarray:
    """(slices + 1,) edges: whole weeks or days where the floor keeps hours and there are ten, else 2,000 equal slices.

    What is left over at the end of the last whole day or week is left out.
    """
    if keeps_hours:
        for cycle_s in (WEEK_S, DAY_S):
            if horizon_s >= FEWEST_CYCLES * cycle_s:
                return np.arange(int(horizon_s // cycle_s) + 1) * cycle_s
    return np.linspace(0.0, horizon_s, FINE + 1)


def waiting(log: EventLog, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) jobs that wait for a station or a worker; stock in stores does not."""
    rows = log.of(QUEUE)
    rows = rows.where(rows["cause"] != STOCK)
    return at_once(rows["start_s"], rows["end_s"], edges_s)


def people_at_work(log: EventLog, edges_s: np.ndarray) -> np.ndarray:
    """(slices,) people in a performance, averaged over each slice."""
    rows = log.of(WORK)
    rows = rows.where(rows["worker"] >= 0)
    return at_once(rows["start_s"], rows["end_s"], edges_s)


@dataclass(frozen=True, slots=True)
class Sliced:
    """One replication: ``by_time`` (slices,) of each series; ``finish_s``, ``stay_s`` (jobs,) of those that finish.

    each : jobs behind each of these values (1 unless there were many); jobs : how many finished
    """

    by_time: dict[str, np.ndarray]
    finish_s: np.ndarray
    stay_s: np.ndarray
    each: int
    jobs: int


BY_TIME: dict[str, Callable[[EventLog, np.ndarray], np.ndarray]] = {
    "throughput_per_h": finished_per_h,
    "work_in_progress": jobs_inside,
    "jobs_waiting": waiting,
    "people_at_work": people_at_work,
}


def sliced(log: EventLog, edges_s: np.ndarray) -> Sliced:
    """What is kept of a log; the log itself may then go."""
    by_time = {name: of(log, edges_s) for name, of in BY_TIME.items()}
    rows = log.of(FINISH)
    rows = rows.where(np.argsort(rows["end_s"], kind="stable"))
    finish_s, stay_s = rows["end_s"], rows["end_s"] - created_s(log, rows["job"])
    each = max(1, -(-finish_s.size // MOST_JOBS))
    last = finish_s.size // each * each
    kept = slice(finish_s.size - last, None)
    return Sliced(
        by_time, finish_s[kept].reshape(-1, each)[:, -1], stay_s[kept].reshape(-1, each).mean(axis=1), each, len(rows)
    )


def jobs_in_a_row(replications: list[Sliced], from_s: float, most: int) -> np.ndarray | None:
    """(R, G) times in system of jobs that finish from a time on, neighbours put together; None with fewer than 10.

    Each replication gives as many values, at most ``most``; the first jobs that fill no group are left out.
    """
    stays = [one.stay_s[one.finish_s >= from_s] for one in replications]
    groups = min(most, min((stay.size for stay in stays), default=0))
    if groups * len(stays) < 10:
        return None
    size = [stay.size // groups for stay in stays]
    return np.array([stay[stay.size - groups * n :].reshape(groups, n).mean(axis=1) for stay, n in zip(stays, size)])
