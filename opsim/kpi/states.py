"""Shares of time: what workers and stations are doing. The parts of each subject sum to 1."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.log import BLOCKED, HELD, JOB_BLOCKED, QUEUE, WAIT, WALK, WORK, EventLog
from opsim.plan import Plan


def worker_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each worker: work, walk, wait (idle), and held (standing by a blocked job) where allocation holds him."""
    length_s = plan.window_s[1] - plan.window_s[0]
    blocked = log["cause"] == JOB_BLOCKED
    parts = {
        "work": _sums(log, plan, log["kind"] == WORK, "worker", len(plan.workers)),
        "walk": _sums(log, plan, log["kind"] == WALK, "worker", len(plan.workers)),
        "wait": _sums(log, plan, (log["kind"] == WAIT) & ~blocked, "worker", len(plan.workers)),
    }
    if plan.when_blocked == "held":
        parts["held"] = _sums(log, plan, (log["kind"] == WAIT) & blocked, "worker", len(plan.workers))
    for rank, worker in enumerate(plan.workers):
        for part, spent_s in parts.items():
            yield Figure("worker_states", worker.name, part, "share", spent_s[rank] / length_s)


def station_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each station, per server: work, blocked, waiting (a job wants a worker), starved (no job)."""
    length_s = plan.window_s[1] - plan.window_s[0]
    parts = {
        part: _sums(log, plan, log["kind"] == kind, "station", len(plan.stations))
        for part, kind in (("work", WORK), ("blocked", BLOCKED), ("waiting", HELD))
    }
    for rank, station in enumerate(plan.stations):
        servers_s = length_s * station.servers
        for part, spent_s in parts.items():
            yield Figure("station_states", station.name, part, "share", spent_s[rank] / servers_s)
        starved_s = servers_s - sum(spent_s[rank] for spent_s in parts.values())
        yield Figure("station_states", station.name, "starved", "share", starved_s / servers_s)


def queue_lengths(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Jobs in the buffer of each station and on its servers waiting for a worker, averaged over the window."""
    length_s = plan.window_s[1] - plan.window_s[0]
    waiting_s = _sums(log, plan, np.isin(log["kind"], (QUEUE, HELD)), "station", len(plan.stations))
    for rank, station in enumerate(plan.stations):
        yield Figure("queue_length", station.name, "", "jobs", waiting_s[rank] / length_s)


def _sums(log: EventLog, plan: Plan, mask: np.ndarray, column: str, n: int) -> np.ndarray:
    """(n,) seconds in the window of the rows of a mask, by the number in a column."""
    mask = mask & (log[column] >= 0)
    return np.bincount(log[column][mask], weights=log.clipped_s(*plan.window_s)[mask], minlength=n)
