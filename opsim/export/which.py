"""Which row of a log is meant: the k-th performance of a task by a worker, his k-th walk, or what he does at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.log import KINDS, SETUP, WALK, WORK, WORKER_KINDS, EventLog
from opsim.plan import Plan
from opsim.problems import did_you_mean, shown
from opsim.walks import walk_rows


@dataclass(frozen=True)
class Which:
    """rows : of the log, the pieces of a performance in order, or the one of a walk; k : which one it is; walk : so"""

    rows: np.ndarray
    worker: int
    k: int
    walk: bool


def performance_of(log: EventLog, plan: Plan, worker: str, task: str, k: int) -> Which:
    """All pieces of a worker's k-th performance of a task, k from 0. Raises ValueError where there is none such."""
    rank = worker_rank(plan, worker)
    names = [one.name for one in plan.tasks]
    if task not in names:
        raise ValueError(f"no task {shown(task)}; {did_you_mean(task, names, otherwise='tasks')}")
    own = _performances(log, rank, names.index(task))
    if not own.size:
        done = sorted({names[at] for at in np.unique(_tasks(log, rank)).tolist()})
        raise ValueError(f"{worker} never performs {task} in replication {log.replication}; {_listed(done)}")
    if not np.any(log["k"][own] == k):
        numbers = np.unique(log["k"][own])
        raise ValueError(f"{worker}, {task}: found no performance {k}, expected one of {_ranges(numbers.tolist())}")
    return _pieces(log, own[log["k"][own] == k][0])


def walk_of(log: EventLog, plan: Plan, worker: str, k: int) -> Which:
    """A worker's k-th walk, k from 0. Raises ValueError where there is none such."""
    rank = worker_rank(plan, worker)
    rows = walk_rows(log)
    rows = rows[log["worker"][rows] == rank]
    if not 0 <= k < rows.size:
        if not rows.size:
            raise ValueError(f"{worker} never walks in replication {log.replication}")
        raise ValueError(f"{worker}: found no walk {k}, expected one of 0 to {rows.size - 1}")
    return Which(rows[k : k + 1], rank, k, True)


def at_time(log: EventLog, plan: Plan, worker: str, time_s: float) -> Which:
    """What a worker performs at a time of the run; at an edge what begins. Raises ValueError where he does not move."""
    rank = worker_rank(plan, worker)
    rows = np.flatnonzero((log["worker"] == rank) & np.isin(log["kind"], WORKER_KINDS))
    here = rows[(log["start_s"][rows] <= time_s) & (time_s < log["end_s"][rows])]
    moves = [row for row in here.tolist() if log["kind"][row] in (WORK, SETUP, WALK)]
    if not moves:
        doing = KINDS[log["kind"][here[0]]] if here.size else "nothing, the run is over"
        raise ValueError(f"{worker} performs nothing then: found {doing}; {_next(log, rows, time_s)}")
    row = moves[0]
    if log["kind"][row] != WALK:
        return _pieces(log, row)
    walks = walk_rows(log)
    own = walks[log["worker"][walks] == rank]
    return Which(np.array([row]), rank, int(np.flatnonzero(own == row)[0]), True)


def worker_rank(plan: Plan, worker: str) -> int:
    """The rank of a worker by name. Raises ValueError with the nearest name."""
    names = [one.name for one in plan.workers]
    if worker not in names:
        raise ValueError(f"no worker {shown(worker)}; {did_you_mean(worker, names, otherwise='workers')}")
    return names.index(worker)


def _pieces(log: EventLog, row: int) -> Which:
    """Every piece of the performance that a row is of, in order of time: those of one worker, task and k."""
    same = np.isin(log["kind"], (WORK, SETUP))
    for name in ("worker", "task", "k"):
        same &= log[name] == log[name][row]
    rows = np.flatnonzero(same)
    rows = rows[np.argsort(log["start_s"][rows], kind="stable")]
    return Which(rows, int(log["worker"][row]), int(log["k"][row]), False)


def _performances(log: EventLog, rank: int, task: int) -> np.ndarray:
    work = np.isin(log["kind"], (WORK, SETUP)) & (log["k"] >= 0)
    return np.flatnonzero(work & (log["worker"] == rank) & (log["task"] == task))


def _tasks(log: EventLog, rank: int) -> np.ndarray:
    work = np.isin(log["kind"], (WORK, SETUP)) & (log["worker"] == rank) & (log["task"] >= 0)
    return log["task"][work]


def _next(log: EventLog, rows: np.ndarray, time_s: float) -> str:
    later = rows[(log["start_s"][rows] >= time_s) & np.isin(log["kind"][rows], (WORK, SETUP, WALK))]
    if not later.size:
        return "nothing follows"
    row = later[np.argmin(log["start_s"][later])]
    what = "a walk" if log["kind"][row] == WALK else log.names["task"][log["task"][row]]
    return f"next is {what}, {log['start_s'][row] - time_s:.1f} s later"


def _listed(words: list[str]) -> str:
    return f"what is performed: {', '.join(words)}" if words else "nothing is performed at all"


def _ranges(numbers: list[int]) -> str:
    if numbers == list(range(numbers[0], numbers[-1] + 1)):
        return f"{numbers[0]} to {numbers[-1]}"
    return ", ".join(map(str, numbers[:12])) + (", ..." if len(numbers) > 12 else "")
