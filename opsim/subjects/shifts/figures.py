"""Hours there and busy, breaks that came late, overtime, and work that was broken off."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.history import FATES, FINISHED, job_pieces
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, duty_hours, in_window, inside_s, open_time_s, window_length_s
from opsim.log import ABSENT, BREAK, OFF, REST, SETUP, WALK, WORK, WORKER_KINDS, EventLog
from opsim.plan import Plan
from opsim.subjects.shifts.hours import has_hours
from opsim.subjects.shifts.plan import Spans, without


def duty(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each worker who has shifts, and of all of them together (no subject), in the window:

    on_duty_h : hours he was there, breaks, meetings and overtime included
    duty_use  : of that time, but for planned breaks and meetings (not for rests by need), how much he worked, set up
        or walked
    overtime_h : hours he was there outside of his shifts, in overtime or to finish what he had begun
    absent_share : of the hours of his shifts, how many he missed because he was absent
    """
    on_shifts = [rank for rank, worker in enumerate(plan.workers) if worker.duties is not None]
    if not on_shifts:
        return
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    found = {rank: _times_s(log, plan, rows[log["worker"][rows] == rank], rank) for rank in on_shifts}
    together = np.sum(list(found.values()), axis=0)
    for name, times_s in [("", together), *((plan.workers[rank].name, found[rank]) for rank in on_shifts)]:
        there_s, paused_s, busy_s, over_s, missed_s, planned_s = times_s.tolist()
        yield figure("on_duty_h", name, "", there_s / SECONDS_PER_HOUR)
        yield figure("duty_use", name, "", busy_s / (there_s - paused_s) if there_s > paused_s else np.nan)
        yield figure("overtime_h", name, "", over_s / SECONDS_PER_HOUR)
        yield figure("absent_share", name, "", missed_s / planned_s if planned_s else np.nan)


def _times_s(log: EventLog, plan: Plan, rows: np.ndarray, rank: int) -> np.ndarray:
    """Seconds in the window of one worker: there, in planned pauses, busy, there outside of shifts, absent, planned."""
    kind, spent_s = log["kind"][rows], inside_s(log, rows, plan)
    there = ~np.isin(kind, (OFF, ABSENT))
    planned = duty_hours(plan, rank)
    outside = without(((0.0, plan.horizon_s),), planned)
    busy = np.isin(kind, (WORK, SETUP, WALK))
    return np.array(
        [
            spent_s[there].sum(),
            spent_s[(kind == BREAK) & (log["cause"][rows] != REST)].sum(),
            spent_s[busy].sum(),
            _meet_s(log, rows[there], plan, outside),
            spent_s[kind == ABSENT].sum(),
            open_time_s(plan, planned),
        ]
    )


def _meet_s(log: EventLog, rows: np.ndarray, plan: Plan, spans: Spans) -> float:
    """Seconds of some rows that lie in the window and in some times."""
    low, high = plan.window_s
    begins, ends = np.maximum(log["start_s"][rows], low), np.minimum(log["end_s"][rows], high)
    return sum(
        float(np.maximum(np.minimum(ends, to_s) - np.maximum(begins, from_s), 0).sum()) for from_s, to_s in spans
    )


def present_s(log: EventLog, plan: Plan) -> np.ndarray:
    """(workers,) seconds of the window in which each was there: neither off nor absent."""
    length_s = plan.window_s[1] - plan.window_s[0]
    rows = np.flatnonzero(np.isin(log["kind"], (OFF, ABSENT)) & (log["worker"] >= 0))
    gone_s = np.bincount(log["worker"][rows], weights=inside_s(log, rows, plan), minlength=len(plan.workers))
    return length_s - gone_s


def interruptions(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Performances broken off in an hour of the window, of all stations (no subject) and of each, by what became of the
    rest (``opsim.history.FATES``): who had begun it went on, another one did later or at once, it was begun anew, or
    nobody has gone on with it.

    Only of floors where people have shifts or stations hours, or form crews: elsewhere ``stops_per_h`` says it.
    """
    if not (has_hours(plan) or plan.crews or plan.lines):
        return
    pieces = job_pieces(log)
    broken = (pieces.fate != FINISHED) & (log["kind"][pieces.row] == WORK)
    broken &= (log["end_s"][pieces.row] < log.horizon_s) & in_window(log["end_s"][pieces.row], plan)
    rows, fates = pieces.row[broken], pieces.fate[broken]
    cells = log["station"][rows].astype(np.int64) * len(FATES) + fates
    n = np.bincount(cells, minlength=len(plan.stations) * len(FATES)).reshape(-1, len(FATES))
    hours = window_length_s(plan) / SECONDS_PER_HOUR
    yield figure("interruptions_per_h", "", "", n.sum() / hours)
    for name, counts in [
        ("", n.sum(axis=0)),
        *((place.name, n[r]) for r, place in enumerate(plan.stations) if place.tasks),
    ]:
        for fate, count in list(zip(FATES, counts))[1:]:
            yield figure("interruptions_per_h", name, fate, count / hours)
