"""Crews: where on the line jobs pass from one member to the next, and how often.

Paced lines: jobs that left them unfinished, and how long they stood, and why.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim import log as kinds
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, in_window, inside_s, mean, window_length_s
from opsim.log import JOB_KINDS, SENT_ON, STANDS, WORK, EventLog
from opsim.plan import Plan
from opsim.subjects.lines.plan import BUCKET_BRIGADE, CrewPlan, LinePlan
from opsim.subjects.tasks.plan import for_product


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
        tasks = [for_product(plan.tasks, task, rank) for one in steps for task in plan.stations[one].tasks]
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
        yield figure("hand_overs_per_h", crew.name, "", rate)
        for first, second in _pairs(crew):
            theirs = here & (found.before == first) & (found.after == second)
            names = f"{plan.workers[first].name} to {plan.workers[second].name}"
            yield figure("handoff_position", crew.name, names, mean(found.position[theirs]))


def _pairs(crew: CrewPlan) -> Iterator[tuple[int, int]]:
    """Neighbours of a bucket brigade, from the start of its line."""
    if crew.kind == BUCKET_BRIGADE:
        yield from zip(crew.workers, crew.workers[1:])


WHY = {"unfinished": kinds.UNFINISHED, "full": kinds.FULL, "down": kinds.IS_DOWN, "closed": kinds.CLOSED}
WHY |= {"away": kinds.AWAY}
"""Why a line stands: part -> cause."""
PLANNED = ("closed", "away")
"""Pauses of the line, which are no stops: told beside them, and not counted."""


def lines(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each paced line, in the window:

    incomplete_share   : of the jobs that left it, those that were sent on unfinished somewhere on it, and by station
                         those that were sent on there; only of lines that send on
    line_stopped_share : share of the time in which it stood, and for what: a job that is not done, no room for who
                         leaves it (full), a station that is down; and beside that, not counted, the share in which it
                         paused as planned: a station closed by its calendar, nobody there (away: breaks, off shift)
    """
    for line in plan.lines:
        if line.sends_on:
            yield from _incomplete(log, plan, line)
        yield from _stood(log, plan, line)


def _incomplete(log: EventLog, plan: Plan, line: LinePlan) -> Iterator[Figure]:
    left = _left(log, plan, line)
    sent = (log["kind"] == SENT_ON) & np.isin(log["station"], line.stations)
    yield figure("incomplete_share", line.name, "", _share(left, log["job"][sent]))
    for rank in line.stations:
        here = log["job"][sent & (log["station"] == rank)]
        yield figure("incomplete_share", line.name, plan.stations[rank].name, _share(left, here))


def _left(log: EventLog, plan: Plan, line: LinePlan) -> np.ndarray:
    """Numbers of the jobs that left the last station of a line in the window."""
    rows = np.flatnonzero(np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0) & (log["station"] == line.stations[-1]))
    job, end_s = log["job"][rows], log["end_s"][rows]
    order = np.lexsort([end_s, job])
    last = order[np.r_[job[order][1:] != job[order][:-1], True][: order.size]]
    return job[last][in_window(end_s[last], plan) & (end_s[last] < log.horizon_s)]


def _share(jobs: np.ndarray, among: np.ndarray) -> float:
    return float(np.isin(jobs, among).mean()) if jobs.size else float("nan")


def _stood(log: EventLog, plan: Plan, line: LinePlan) -> Iterator[Figure]:
    rows = np.flatnonzero((log["kind"] == STANDS) & (log["station"] == line.stations[0]))
    seconds, length_s = inside_s(log, rows, plan), window_length_s(plan)
    stops = ~np.isin(log["cause"][rows], [WHY[part] for part in PLANNED])
    yield figure("line_stopped_share", line.name, "", seconds[stops].sum() / length_s)
    for part in possible(plan, line):
        share = seconds[log["cause"][rows] == WHY[part]].sum() / length_s
        yield figure("line_stopped_share", line.name, part, share)


def possible(plan: Plan, line: LinePlan) -> list[str]:
    """Why a line can come to stand."""
    after = {step for product in plan.products for step in _steps_after(product, line)}
    found = {
        "unfinished": not line.sends_on,
        "full": bool(after),
        "down": any(stop.station in line.stations for stop in plan.stops),
        "closed": any(plan.stations[rank].open_s is not None for rank in line.stations),
        "away": any(worker.duties is not None for worker in plan.workers),
    }
    return [part for part, can_be in found.items() if can_be]


def _steps_after(product, line: LinePlan) -> set[int]:
    """Steps of a product's route that follow the last station of a line."""
    lasts = [step for step, operation in enumerate(product.route) if line.stations[-1] in operation.stations]
    return {onward for step in lasts for _, onward in product.onward[step] if onward >= 0}
