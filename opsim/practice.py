"""Which repetition each performance was, read again from the rows of a log: by what the worker had behind him then."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.human.memory import Memory, experience_of, first_times
from opsim.log import SETUP, WORK, EventLog
from opsim.plan import Plan


@dataclass(frozen=True, slots=True)
class Practice:
    """Of each row of work of a worker at his own pace: ``row`` (R,) its number in the log, ``repetition`` (R,) which
    repetition its performance was, forgotten ones not counted, ``multiplier`` (R,) of time that this gives."""

    row: np.ndarray
    repetition: np.ndarray
    multiplier: np.ndarray


def own_rows(log: EventLog, plan: Plan) -> np.ndarray:
    """Numbers of the rows of work and set-ups whose time is the worker's own draw, by worker and start."""
    by_worker = np.array([not task.attended for task in plan.tasks])
    named = (log["worker"] >= 0) & (log["task"] >= 0) & (log["k"] >= 0)
    rows = np.flatnonzero(named & np.isin(log["kind"], (WORK, SETUP)))
    rows = rows[by_worker[log["task"][rows]]]
    return rows[np.lexsort((log["end_s"][rows], log["start_s"][rows], log["worker"][rows]))]


def practice(log: EventLog, plan: Plan) -> Practice:
    """The repetition and the multiplier behind each row; without learning, both by count alone and 1.

    Without forgetting, draws are counted: also of what was broken off in the instant in which it began.
    """
    rows, learning = own_rows(log, plan), plan.human.learning
    counted = _counted(log, plan, rows)
    n = counted if plan.human.forgetting is None or learning is None else _remembered(log, plan, rows)
    if learning is None:
        return Practice(rows, n, np.ones(rows.size))
    different, which = np.unique(n, return_inverse=True)
    return Practice(rows, n, np.array([learning.multiplier(one) for one in different.tolist()])[which])


def _counted(log: EventLog, plan: Plan, rows: np.ndarray) -> np.ndarray:
    """(R,) his experience at the start, and one for each performance until this one."""
    worker, task, k = (log[name][rows] for name in ("worker", "task", "k"))
    behind = np.array([experience_of(plan, at) or (0.0,) * len(plan.tasks) for at in range(len(plan.workers))])
    return (behind[worker, task] if rows.size else np.empty(0)) + k + 1.0


def _remembered(log: EventLog, plan: Plan, rows: np.ndarray) -> np.ndarray:
    """(R,) as the engine counted it, by the same memory, told the same in the same order."""
    first_s = first_times(plan, plan.human.learning)
    columns = [log[name][rows].tolist() for name in ("worker", "task", "k", "start_s", "end_s")]
    begun: dict[tuple[int, int], float] = {}
    found, memory, at = np.empty(rows.size), None, -1
    for place, (worker, task, k, start_s, end_s) in enumerate(zip(*columns)):
        if memory is None or worker != at:
            at, begun = worker, {}
            memory = Memory(plan.human.learning, plan.human.forgetting, experience_of(plan, worker), first_s)
        if (task, k) not in begun:  # else it is gone on with, maybe after others of the task
            begun[task, k] = memory.begins(task, k, start_s)
        memory.works(start_s, task, k, end_s)
        found[place] = begun[task, k]
    return found
