"""How far workers walk, empty-handed and with a job, and the from-to chart of their trips."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.history import on_grid_each, ways_m
from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import SECONDS_PER_HOUR, in_window, inside_s, window_length_s
from opsim.log import TRANSPORT, WALK, EventLog
from opsim.plan import Plan


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
