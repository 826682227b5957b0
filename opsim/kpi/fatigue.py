"""How tired people are as they work, and how long they rest by need. Figures exist only where the scenario names it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.duty import present_s
from opsim.kpi.figure import Figure
from opsim.kpi.values import inside_s
from opsim.log import BREAK, REST, EventLog
from opsim.plan import Plan
from opsim.tiredness import Tiredness, tiredness


def fatigue(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Where people tire, of all of them (no subject) and of each, in the window:

    fatigue_mean : their fatigue, 0 to 1, over the time they work: half of it as a piece of work begins, half as it ends
    fatigue_most : the most that any piece of work has left; part: a joint, where the model follows joints
    rest_taken_min_per_h : minutes of rest by need in an hour in which they are there; only where people rest so
    """
    if plan.human.fatigue is None:
        return
    found = tiredness(log, plan)
    spent_s, worker = inside_s(log, found.row, plan), log["worker"][found.row]
    for name, rows in _of_whom(worker, plan):
        own = np.flatnonzero(rows & (spent_s > 0))
        yield Figure("fatigue_mean", name, "", "share", _mean(found, spent_s, own))
        yield Figure("fatigue_most", name, "", "share", found.end[own].max() if own.size else np.nan)
        for at, joint in enumerate(found.joints):
            yield Figure("fatigue_most", name, joint, "share", found.by_joint[own, at].max() if own.size else np.nan)
    if plan.human.rest is not None:
        yield from _rested(log, plan)


def _of_whom(worker: np.ndarray, plan: Plan) -> Iterator[tuple[str, np.ndarray]]:
    yield "", np.ones(worker.size, bool)
    yield from ((person.name, worker == rank) for rank, person in enumerate(plan.workers))


def _mean(found: Tiredness, spent_s: np.ndarray, own: np.ndarray) -> float:
    if not own.size:
        return float("nan")
    return float(np.average(0.5 * (found.begin[own] + found.end[own]), weights=spent_s[own]))


def _rested(log: EventLog, plan: Plan) -> Iterator[Figure]:
    rows = np.flatnonzero((log["kind"] == BREAK) & (log["cause"] == REST))
    there_s = present_s(log, plan)
    taken_s = np.bincount(log["worker"][rows], weights=inside_s(log, rows, plan), minlength=there_s.size)
    for name, rested, there in (
        ("", taken_s.sum(), there_s.sum()),
        *((person.name, taken_s[rank], there_s[rank]) for rank, person in enumerate(plan.workers)),
    ):
        yield Figure("rest_taken_min_per_h", name, "", "min/h", 60.0 * rested / there if there > 0 else np.nan)
