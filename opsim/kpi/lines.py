"""Paced lines: jobs that left them unfinished, and how long they stood, and why."""

from collections.abc import Iterator

import numpy as np

from opsim import log as kinds
from opsim.kpi.figure import Figure
from opsim.kpi.values import in_window, inside_s, window_length_s
from opsim.log import JOB_KINDS, SENT_ON, STANDS, EventLog
from opsim.plan import LinePlan, Plan

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
    yield Figure("incomplete_share", line.name, "", "share", _share(left, log["job"][sent]))
    for rank in line.stations:
        here = log["job"][sent & (log["station"] == rank)]
        yield Figure("incomplete_share", line.name, plan.stations[rank].name, "share", _share(left, here))


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
    yield Figure("line_stopped_share", line.name, "", "share", seconds[stops].sum() / length_s)
    for part in possible(plan, line):
        share = seconds[log["cause"][rows] == WHY[part]].sum() / length_s
        yield Figure("line_stopped_share", line.name, part, "share", share)


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
