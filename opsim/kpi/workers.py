"""Figures of workers: hours there and busy, interruptions, learning, fatigue and rest, walking, and the from-to chart.

Those of shifts, learning, fatigue and rest exist only where the scenario names what they are of.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.history import FATES, FINISHED, Practice, Tiredness, job_pieces, on_grid_each, practice, tiredness, ways_m
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, duty_hours, in_window, inside_s, open_time_s, window_length_s
from opsim.log import ABSENT, BREAK, OFF, REST, SETUP, TRANSPORT, WALK, WORK, WORKER_KINDS, EventLog
from opsim.plan import Plan
from opsim.plan.calendar import Spans, without
from opsim.plan.hours import has_hours


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
    yield figure("learned_share", "", "", _mean(share))
    for rank, person in enumerate(plan.workers):
        rows = np.flatnonzero(worker == rank)
        yield figure("learned_share", person.name, "", _mean(share[rows]))
        for at in np.unique(task[rows]).tolist():
            last = rows[task[rows] == at][-1]
            yield figure("learned_share", person.name, plan.tasks[at].name, share[last])
            yield figure("experience", person.name, plan.tasks[at].name, found.repetition[last])


def _in_window(log: EventLog, plan: Plan, found: Practice) -> Practice:
    """The first rows of the performances that begin in the window."""
    _, first = np.unique(log["performance_id"][found.row], return_index=True)
    first = np.sort(first[in_window(log["start_s"][found.row[first]], plan)])
    return Practice(found.row[first], found.repetition[first], found.multiplier[first])


def _mean(values: np.ndarray) -> float:
    return float(values.mean()) if values.size else float("nan")


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
        yield figure("fatigue_mean", name, "", _mean_fatigue(found, spent_s, own))
        yield figure("fatigue_most", name, "", found.end[own].max() if own.size else np.nan)
        for at, joint in enumerate(found.joints):
            yield figure("fatigue_most", name, joint, found.by_joint[own, at].max() if own.size else np.nan)
    if plan.human.rest is not None:
        yield from _rested(log, plan)


def _of_whom(worker: np.ndarray, plan: Plan) -> Iterator[tuple[str, np.ndarray]]:
    yield "", np.ones(worker.size, bool)
    yield from ((person.name, worker == rank) for rank, person in enumerate(plan.workers))


def _mean_fatigue(found: Tiredness, spent_s: np.ndarray, own: np.ndarray) -> float:
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
        yield figure("rest_taken_min_per_h", name, "", 60.0 * rested / there if there > 0 else np.nan)


def walked(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Metres each worker walks in the window; a walk across an edge of it or cut by the horizon counts in part."""
    rows = np.flatnonzero(log["kind"] == WALK)
    worker = log["worker"][rows]
    speed = np.array([w.walk_m_per_s for w in plan.workers])[worker]
    way_m = ways_m(log, plan, rows, speed)
    whole_s = on_grid_each(way_m / speed)
    share = np.minimum(1.0, inside_s(log, rows, plan) / whole_s)
    metres = np.bincount(worker, weights=way_m * share, minlength=len(plan.workers))
    for rank, person in enumerate(plan.workers):
        yield figure("walked_m", person.name, "", metres[rank])


EMPTY_HANDED, WITH_A_JOB, DRIVEN = "empty_handed", "with_a_job", "driven"
WALKED = (EMPTY_HANDED, WITH_A_JOB)
"""Parts that people walk."""
_TO = " > "


def trips(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Trips that end in an hour of the window, by the two places as ``saw > drill``; ways of no length are none.

    empty_handed, with_a_job : walks of people; driven : by vehicles, with jobs or without. What rides on a belt, or
    passes without time, is no trip.
    """
    hours = window_length_s(plan) / SECONDS_PER_HOUR
    for part, start, end in _ended(log, plan):
        pairs, counts = np.unique(start.astype(np.int64) * len(plan.places) + end, return_counts=True)
        for pair, count in zip(pairs.tolist(), counts.tolist()):
            a, b = divmod(pair, len(plan.places))
            yield figure("trips_per_h", subject_of_trip(plan.places[a], plan.places[b]), part, count / hours)


def subject_of_trip(start: str, end: str) -> str:
    """How a trip is called."""
    return f"{start}{_TO}{end}"


def ends_of_trip(subject: str) -> tuple[str, str]:
    """(from, to) of a trip; no place can have the sign between them in its name."""
    start, end = subject.split(_TO)
    return start, end


def _ended(log: EventLog, plan: Plan) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """(part, ranks of places from, to) of what ends in the window."""
    ends = in_window(log["end_s"], plan) & (log["place_from"] != log["place_to"]) & (log["place_from"] >= 0)
    walks = np.flatnonzero(ends & (log["kind"] == WALK) & (log["worker"] >= 0))
    carried = _with_a_job(log, plan, walks)
    driven = np.flatnonzero(ends & (log["kind"] == TRANSPORT) & (log["job"] < 0))
    for part, rows in ((EMPTY_HANDED, walks[~carried]), (WITH_A_JOB, walks[carried]), (DRIVEN, driven)):
        yield part, log["place_from"][rows], log["place_to"][rows]


def _with_a_job(log: EventLog, plan: Plan, walks: np.ndarray) -> np.ndarray:
    """(n,) whether somebody carries a job on a walk: the job is under way to where he goes.

    Of walks to and fro with the parts of a heavy lot, those towards the station are.
    """
    places = np.array([station.place for station in plan.stations])
    moved = np.flatnonzero((log["kind"] == TRANSPORT) & (log["job"] >= 0) & (log["station"] >= 0))
    of_job: dict[tuple[int, int], list[tuple[float, float, int]]] = {}
    columns = [log[name][moved].tolist() for name in ("source", "job", "start_s", "end_s")]
    for source, job, start_s, end_s, goal in zip(*columns, places[log["station"][moved]].tolist()):
        of_job.setdefault((source, job), []).append((start_s, end_s, goal))
    walked = zip(*(log[name][walks].tolist() for name in ("source", "job", "start_s", "end_s", "place_to")))
    carried = [
        any(begin <= start_s and end_s <= end and to == goal for begin, end, goal in of_job.get((source, job), ()))
        for source, job, start_s, end_s, to in walked
    ]
    return np.array(carried, dtype=bool)
