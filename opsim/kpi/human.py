"""What people have learned. Figures exist only where the scenario names the effect."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import in_window
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.practice import Practice, practice


def learned(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Where people learn, of the performances that begin in the window:

    learned_share : time as a share of that of the first repetition; the mean of all and of each worker, and, with the
                    task as part, that of his last one
    experience    : repetitions behind a worker, by task, after his last one; forgotten ones do not count
    """
    if plan.human.learning is None:
        return
    found = _in_window(log, plan, practice(log, plan))
    share = found.multiplier / plan.human.learning.multiplier(1.0)
    worker, task = log["worker"][found.row], log["task"][found.row]
    yield Figure("learned_share", "", "", "share", _mean(share))
    for rank, person in enumerate(plan.workers):
        rows = np.flatnonzero(worker == rank)
        yield Figure("learned_share", person.name, "", "share", _mean(share[rows]))
        for at in np.unique(task[rows]).tolist():
            last = rows[task[rows] == at][-1]
            yield Figure("learned_share", person.name, plan.tasks[at].name, "share", share[last])
            yield Figure("experience", person.name, plan.tasks[at].name, "", found.repetition[last])


def _in_window(log: EventLog, plan: Plan, found: Practice) -> Practice:
    """The first rows of the performances that begin in the window."""
    _, first = np.unique(log["performance_id"][found.row], return_index=True)
    first = np.sort(first[in_window(log["start_s"][found.row[first]], plan)])
    return Practice(found.row[first], found.repetition[first], found.multiplier[first])


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if values.size else float("nan")
