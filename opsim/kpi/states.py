"""Shares of time: what workers are doing. The parts of each subject sum to 1."""

from collections.abc import Iterator

import numpy as np

from opsim import log as kinds
from opsim.kpi.figure import Figure
from opsim.kpi.values import inside_s, window_length_s
from opsim.log import BREAK, WAIT, EventLog
from opsim.plan import Plan

WORK, WALK, IDLE = "work", "walk", "wait"
BY_KIND = {
    **{kinds.WORK: WORK, kinds.WALK: WALK, kinds.TRANSPORT: WALK, kinds.WAIT: IDLE, kinds.SETUP: "setup"},
    **{kinds.BREAK: "break", kinds.OFF: "off", kinds.ABSENT: "absent"},
}
BY_CAUSE = {
    **{(WAIT, kinds.JOB_BLOCKED): "held", (WAIT, kinds.TEAM): "team", (WAIT, kinds.NO_TOOL): "tool"},
    **{(WAIT, kinds.BEHIND): "behind", (BREAK, kinds.MEETING): "meeting", (BREAK, kinds.REST): "rest"},
}
STATES = tuple(dict.fromkeys([*BY_KIND.values(), *BY_CAUSE.values()]))


def worker_states(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each worker: work, walk, wait (idle), and what else people do here.

    held : standing by a blocked job, where allocation holds him, or he is to carry it; setup : setting a station up;
    team : waiting for the others of a team, before the work or after it; tool : waiting, in the middle of a task, for
    the tool it takes now; behind : waiting for the member of his crew who is ahead of him; rest : by need; break,
    meeting, off, absent : of floors where people work in shifts
    """
    rows, state = states_of_rows(log)
    cell = log["worker"][rows].astype(np.int64) * len(STATES) + state
    n_cells = len(plan.workers) * len(STATES)
    spent_s = np.bincount(cell, weights=inside_s(log, rows, plan), minlength=n_cells).reshape(-1, len(STATES))
    for worker, of_worker in zip(plan.workers, spent_s):
        for part in possible(plan):
            yield Figure(
                "worker_states", worker.name, part, "share", of_worker[STATES.index(part)] / window_length_s(plan)
            )


def states_of_rows(log: EventLog) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of the rows that say what a worker does, and (rows,) which of ``STATES`` that is."""
    rows = np.flatnonzero((log["worker"] >= 0) & np.isin(log["kind"], list(BY_KIND)))
    kind, cause = log["kind"][rows], log["cause"][rows]
    of_kind = np.zeros(len(kinds.KINDS), dtype=np.int64)
    for number, state in BY_KIND.items():
        of_kind[number] = STATES.index(state)
    found = of_kind[kind]
    for (number, why), state in BY_CAUSE.items():
        found[(kind == number) & (cause == why)] = STATES.index(state)
    return rows, found


def possible(plan: Plan) -> list[str]:
    """The states that workers of a plan can be in."""
    can_be = {
        "held": plan.when_blocked == "held" or any(product.carried for product in plan.products),
        "setup": any(setup.attended for setup in plan.setups),
        "team": any(task.team > 1 for task in plan.tasks),
        "tool": any(task.hold is not None for task in plan.tasks),
        "behind": bool(plan.crews),
        "rest": plan.human.rest is not None,
        **dict.fromkeys(("break", "meeting", "off", "absent"), any(w.duties is not None for w in plan.workers)),
    }
    return [WORK, WALK, IDLE, *(part for part, can in can_be.items() if can)]
