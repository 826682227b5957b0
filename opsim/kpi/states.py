"""Shares of time: what workers and stations are doing. The parts of each subject sum to 1."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import inside_s, window_length_s
from opsim.log import JOB_BLOCKED, KINDS, NO_TOOL, SETUP, TEAM, TRANSPORT, WAIT, WALK, WORK, EventLog
from opsim.plan import Plan


def worker_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each worker: work, walk, wait (idle), and what else people do here.

    held : standing by a blocked job, where allocation holds him, or he is to carry it; setup : setting a station up;
    team : waiting for the others of a team, before the work or after it; tool : waiting, in the middle of a task, for
    the tool it takes now
    """
    rows = np.flatnonzero(log["worker"] >= 0)
    kinds = _seconds_by_kind(log, plan, rows)
    waits = rows[log["kind"][rows] == WAIT]
    held_s, team_s, tool_s = (
        _seconds_by_kind(log, plan, waits[log["cause"][waits] == cause])[:, WAIT]
        for cause in (JOB_BLOCKED, TEAM, NO_TOOL)
    )
    parts = {"work": kinds[:, WORK], "walk": kinds[:, WALK] + kinds[:, TRANSPORT]}
    parts["wait"] = kinds[:, WAIT] - held_s - team_s - tool_s
    if plan.when_blocked == "held" or any(product.carried for product in plan.products):
        parts["held"] = held_s
    if any(setup.attended for setup in plan.setups):
        parts["setup"] = kinds[:, SETUP]
    if any(task.team > 1 for task in plan.tasks):
        parts["team"] = team_s
    if any(task.hold is not None for task in plan.tasks):
        parts["tool"] = tool_s
    for rank, worker in enumerate(plan.workers):
        for part, spent_s in parts.items():
            yield Figure("worker_states", worker.name, part, "share", spent_s[rank] / window_length_s(plan))


def _seconds_by_kind(log: EventLog, plan: Plan, rows: np.ndarray) -> np.ndarray:
    """(workers, kinds) seconds in the window of some rows, by worker and by kind."""
    n = len(plan.workers)
    cell = log["worker"][rows].astype(np.int64) * len(KINDS) + log["kind"][rows]
    return np.bincount(cell, weights=inside_s(log, rows, plan), minlength=n * len(KINDS)).reshape(n, len(KINDS))
