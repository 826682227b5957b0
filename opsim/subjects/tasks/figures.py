"""The law of heights: hands are at the height that the product, or the layer in turn, asks for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.laws.jobs import Stays
from opsim.log import SETUP, WORK, EventLog
from opsim.plan import Plan
from opsim.subjects.tasks.plan import Levels, performed_ranks


def heights(log: EventLog, plan: Plan, _stays: Stays) -> Iterator[str]:
    """What was begun goes on, and begins anew, at its own level; every other performance takes that of its product, or
    the next piece of the layer in turn.

    Of layers nothing can be asked where a performance was broken off in the instant in which it began: it has no row.
    """
    seen = np.unique(log["performance_id"][log["performance_id"] >= 0])
    complete = bool(seen.size == 0 or seen.size == seen[-1] + 1)
    for rank, task in enumerate(plan.tasks):
        if task.levels is not None and (complete or not task.levels.pieces_each):
            yield from _heights_of(log, plan, rank, task.levels)


def _heights_of(log: EventLog, plan: Plan, rank: int, levels: Levels) -> Iterator[str]:
    ours = np.isin(log["task"], [rank, *performed_ranks(plan.tasks, rank)]) & np.isin(log["kind"], (WORK, SETUP))
    rows = np.flatnonzero(ours & (log["job"] >= 0))
    rows = rows[np.lexsort((log["start_s"][rows], log["performance_id"][rows]))]
    columns = (log[name][rows].tolist() for name in ("job", "product", "task", "progress_to", "start_s"))
    n_begun, begun = 0, dict[int, int]()
    for job, product, found, done, start_s in zip(*columns):
        expected = begun.pop(job, -1)
        if expected < 0:
            each = levels.pieces_each
            expected = levels.tasks[n_begun // each % len(levels.tasks) if each else product]
            n_begun += 1
        if found != expected:
            names = plan.tasks[found].name, plan.tasks[expected].name
            yield f"job {job}, at {start_s:.9g} s: {names[0]}, where {names[1]} is next"
            return
        if done < 1.0:
            begun[job] = found
