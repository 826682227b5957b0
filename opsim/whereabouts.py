"""Where everybody is all the time: what a replay shows, and the proof that nothing of it is missing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from opsim.clock import ticks
from opsim.log import ABSENT, OFF, REPAIR, SETUP, WALK, WORK, WORKER_KINDS, EventLog
from opsim.plan import Plan

NOWHERE = -1
"""The place of who is off or absent: he is not on the floor."""


@dataclass(frozen=True)
class Whereabouts:
    """What workers do and where, by worker and time; every array is (R,).

    row : which row of the log; place_from, place_to : ranks of places, the same but where somebody walks; ``NOWHERE``
    """

    row: np.ndarray
    worker: np.ndarray
    kind: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray
    place_from: np.ndarray
    place_to: np.ndarray


def whereabouts(log: EventLog, plan: Plan) -> Whereabouts:
    """All rows of workers; who works is where the station is."""
    rows = np.flatnonzero(np.isin(log["kind"], WORKER_KINDS) & (log["worker"] >= 0))
    rows = rows[np.lexsort([log["end_s"][rows], log["start_s"][rows], log["worker"][rows]])]
    kind, station = log["kind"][rows], log["station"][rows]
    of_station = np.array([*(place.place for place in plan.stations), NOWHERE])
    at_work = np.isin(kind, (WORK, SETUP, REPAIR))
    gone = np.isin(kind, (OFF, ABSENT))
    places = (
        np.where(gone, NOWHERE, np.where(at_work, of_station[station], log[name][rows]))
        for name in ("place_from", "place_to")
    )
    return Whereabouts(rows, log["worker"][rows], kind, log["start_s"][rows], log["end_s"][rows], *places)


def unaccounted(log: EventLog, plan: Plan) -> Iterator[str]:
    """Every second of a worker that the rows do not account for with one thing he does and one place, in words.

    Each second of the run belongs to exactly one row; nobody who is there is nowhere; nobody moves but by a walk, whose
    ends are apart; who comes back from outside stands at his home. Nothing is yielded where a replay can be whole.
    """
    seen = whereabouts(log, plan)
    first = np.searchsorted(seen.worker, np.arange(len(plan.workers) + 1))
    for rank, (begin, end) in enumerate(pairwise(first.tolist())):
        for found in (*_times(seen, begin, end, log.horizon_s), *_places(seen, begin, end, plan, rank)):
            yield f"worker {plan.workers[rank].name}: {found}"


def _times(seen: Whereabouts, begin: int, end: int, horizon_s: float) -> Iterator[str]:
    ends, starts = (
        ticks(edge) for edge in (np.r_[0.0, seen.end_s[begin:end]], np.r_[seen.start_s[begin:end], horizon_s])
    )
    for at in np.flatnonzero(ends != starts)[:1]:
        what = "two things at once" if ends[at] > starts[at] else "nothing is known of him"
        yield f"{what} from {min(ends[at], starts[at]) / 2**20:g} s to {max(ends[at], starts[at]) / 2**20:g} s"


def _places(seen: Whereabouts, begin: int, end: int, plan: Plan, rank: int) -> Iterator[str]:
    place_from, place_to = seen.place_from[begin:end], seen.place_to[begin:end]
    kind, start_s = seen.kind[begin:end], seen.start_s[begin:end]
    nowhere = ~np.isin(kind, (OFF, ABSENT)) & ((place_from < 0) | (place_to < 0))
    for at in np.flatnonzero(nowhere)[:1]:
        yield f"there, but at no place at {start_s[at]:g} s"
    at_home = plan.workers[rank].place
    came_from = np.r_[at_home, np.where(place_to < 0, at_home, place_to)[:-1]]
    apart_m = np.array(plan.distance_m)[came_from, place_from]
    jumps = (place_from >= 0) & (came_from != place_from) & (apart_m > 0)
    for at in np.flatnonzero(jumps)[:1]:
        here, there = plan.places[place_from[at]], plan.places[came_from[at]]
        yield f"at {here} at {start_s[at]:g} s, and no walk led there from {there}"
    moves = (kind != WALK) & (place_from != place_to)
    for at in np.flatnonzero(moves)[:1]:
        yield f"moves without a walk at {start_s[at]:g} s"
