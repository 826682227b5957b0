"""Crews: where on the line jobs pass from one member to the next, and how often."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import SECONDS_PER_HOUR, in_window, mean, window_length_s
from opsim.log import WORK, EventLog
from opsim.plan import Plan
from opsim.plan.crews import BUCKET_BRIGADE, CrewPlan


@dataclass(frozen=True, slots=True)
class HandOvers:
    """Those of one crew in the order of time, each array (n,).

    at_s     : when who took the job on began; before, after : ranks of the workers, of whom who gave it and who took it
    position : share of the job's work at the crew's stations that was done then, by mean times
    """

    at_s: np.ndarray
    before: np.ndarray
    after: np.ndarray
    position: np.ndarray


def hand_overs(log: EventLog, plan: Plan, crew: CrewPlan) -> HandOvers:
    """All hand-overs of a crew: a job is worked on by one member, then by another, at any of its stations.

    Automatic work counts as done, and as nobody's. A job that is reworked may come to more than 1.
    """
    rows = np.flatnonzero((log["kind"] == WORK) & np.isin(log["station"], crew.stations))
    rows = rows[np.lexsort([log["start_s"][rows], log["job"][rows]])]
    task_s = np.array([task.model.mean_duration_s() for task in plan.tasks])
    work_s = (log["progress_to"][rows] - log["progress_from"][rows]) * task_s[log["task"][rows]]
    done_s, job = np.cumsum(work_s) - work_s, log["job"][rows]
    first = np.flatnonzero(np.r_[True, job[1:] != job[:-1]]) if rows.size else np.array([], dtype=int)
    done_s -= np.repeat(done_s[first], np.diff(np.r_[first, rows.size]))
    share = done_s / _work_s(plan, crew)[log["product"][rows]]
    manned = log["worker"][rows] >= 0
    rows, share, job = rows[manned], share[manned], job[manned]
    worker = log["worker"][rows]
    changed = np.flatnonzero((job[1:] == job[:-1]) & (worker[1:] != worker[:-1])) + 1
    changed = changed[np.argsort(log["start_s"][rows[changed]], kind="stable")]
    return HandOvers(log["start_s"][rows[changed]], worker[changed - 1], worker[changed], share[changed])


def _work_s(plan: Plan, crew: CrewPlan) -> np.ndarray:
    """(products,) mean seconds of the work that a job of each product has at the stations of a crew."""
    found = np.full(len(plan.products), np.nan)
    for rank, product in enumerate(plan.products):
        steps = [step.stations[0] for step in product.route if set(step.stations) <= set(crew.stations)]
        tasks = [plan.tasks[task] for station in steps for task in plan.stations[station].tasks]
        found[rank] = sum(task.mean_s() * (1 if task.per_lot else product.lot) for task in tasks) or np.nan
    return found


def crews(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each crew: hand-overs an hour, and for each pair of members where on the line they are on average.

    A pair that hands nothing over in the window has no position. Source: Bartholdi & Eisenstein 1996, A production line
    that balances itself, Operations Research 44(1).
    """
    for crew in plan.crews:
        found = hand_overs(log, plan, crew)
        here = in_window(found.at_s, plan)
        rate = np.count_nonzero(here) / window_length_s(plan) * SECONDS_PER_HOUR
        yield Figure("hand_overs_per_h", crew.name, "", "1/h", rate)
        for first, second in _pairs(crew):
            theirs = here & (found.before == first) & (found.after == second)
            names = f"{plan.workers[first].name} to {plan.workers[second].name}"
            yield Figure("handoff_position", crew.name, names, "share", mean(found.position[theirs]))


def _pairs(crew: CrewPlan) -> Iterator[tuple[int, int]]:
    """Neighbours of a bucket brigade, from the start of its line."""
    if crew.kind == BUCKET_BRIGADE:
        yield from zip(crew.workers, crew.workers[1:])
