"""Shares of time: what workers and stations are doing. The parts of each subject sum to 1."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import inside_s, window_length_s
from opsim.log import BLOCKED, HELD, JOB_BLOCKED, KINDS, QUEUE, WAIT, WALK, WORK, EventLog
from opsim.plan import Plan


def worker_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each worker: work, walk, wait (idle), and held (standing by a blocked job) where allocation holds him."""
    rows = np.flatnonzero(log["worker"] >= 0)
    seconds = _seconds_by_kind(log, plan, rows, "worker", len(plan.workers))
    held = rows[(log["kind"][rows] == WAIT) & (log["cause"][rows] == JOB_BLOCKED)]
    held_s = _seconds_by_kind(log, plan, held, "worker", len(plan.workers))[:, WAIT]
    parts = {"work": seconds[:, WORK], "walk": seconds[:, WALK], "wait": seconds[:, WAIT] - held_s}
    if plan.when_blocked == "held":
        parts["held"] = held_s
    for rank, worker in enumerate(plan.workers):
        for part, spent_s in parts.items():
            yield Figure("worker_states", worker.name, part, "share", spent_s[rank] / window_length_s(plan))


def station_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each station, per server: work, blocked, waiting (a job wants a worker), starved (no job).

    And the jobs in its buffer or on its servers waiting for a worker, averaged over the window.
    """
    length_s = window_length_s(plan)
    on_floor = np.flatnonzero((log["station"] >= 0) & np.isin(log["kind"], (WORK, BLOCKED, HELD, QUEUE)))
    seconds = _seconds_by_kind(log, plan, on_floor, "station", len(plan.stations))
    for rank, station in enumerate(plan.stations):
        shares = seconds[rank] / (length_s * station.servers)
        parts = {"work": shares[WORK], "blocked": shares[BLOCKED], "waiting": shares[HELD]}
        for part, share in {**parts, "starved": 1.0 - sum(parts.values())}.items():
            yield Figure("station_states", station.name, part, "share", share)
    for rank, station in enumerate(plan.stations):
        waiting_s = seconds[rank, QUEUE] + seconds[rank, HELD]
        yield Figure("queue_length", station.name, "", "jobs", waiting_s / length_s)


def _seconds_by_kind(log: EventLog, plan: Plan, rows: np.ndarray, column: str, n: int) -> np.ndarray:
    """(n, kinds) seconds in the window of some rows, by the subject in a column and by kind."""
    cell = log[column][rows].astype(np.int64) * len(KINDS) + log["kind"][rows]
    return np.bincount(cell, weights=inside_s(log, rows, plan), minlength=n * len(KINDS)).reshape(n, len(KINDS))
