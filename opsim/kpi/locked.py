"""Whether a floor has locked itself: jobs that wait for each other in a ring and will wait for ever."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.log import BLOCKED, HELD, JOB_BLOCKED, JOB_KINDS, NO_WORKER, QUEUE, WAIT, EventLog
from opsim.plan import Plan


@dataclass(frozen=True, slots=True)
class Locked:
    """stations : names in the order of the ring, each waiting for the next and the last for the first

    since_s : when the ring closed; workers : names of those who are waited for and stand by a job of the ring
    """

    stations: tuple[str, ...]
    since_s: float
    workers: tuple[str, ...] = ()


def locked(log: EventLog, plan: Plan) -> Locked | None:
    """The ring that closed first, from what was open at the horizon; None where everything could still move.

    A job that blocks a server is stuck where all stations of the operation it wants (its row names it) are full and
    every job on their servers is stuck; a job that wants back into its own station never is, since it may take its own
    place again. A job on a server that waits for a worker is stuck where everyone who could come stands by a stuck
    job. The stuck jobs are the largest set for which this holds.
    Source: Coffman, Elphick & Shoshani 1971, System deadlocks, Computing Surveys 3(2) (circular wait).
    """
    rows = log.where((log["end_s"] == log.horizon_s) & np.isin(log["kind"], (*JOB_KINDS, WAIT)))
    inside = rows.where(np.isin(rows["kind"], JOB_KINDS) & (rows["station"] >= 0))
    seated = inside.where(inside["kind"] != QUEUE)
    needs = dict(_needs(seated, _full(inside, plan), _held(rows), plan))
    rings = (_ring(seated, ring, needs, plan) for ring in _closed_rings(needs, _stuck(needs)))
    return min(rings, key=lambda ring: (ring.since_s, ring.stations), default=None)


def _full(inside: EventLog, plan: Plan) -> np.ndarray:
    """(S,) whether each station has no room."""
    n_inside = np.bincount(inside["station"], minlength=len(plan.stations))
    return n_inside >= np.array([station.capacity for station in plan.stations])


def _held(rows: EventLog) -> dict[int, int]:
    """worker -> the blocked job that holds him."""
    held = rows.where((rows["kind"] == WAIT) & (rows["cause"] == JOB_BLOCKED))
    return dict(zip(held["worker"].tolist(), held["job"].tolist()))


def _needs(
    seated: EventLog, full: np.ndarray, held: dict[int, int], plan: Plan
) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Of each seated job that waits: the numbers of the seated jobs all of which must be stuck for it to be so."""
    route_of = {operation.name: operation.stations for product in plan.products for operation in product.route}
    seats: dict[int, list[int]] = {}
    for seat, station in enumerate(seated["station"].tolist()):
        seats.setdefault(station, []).append(seat)
    seat_of = {job: seat for seat, job in enumerate(seated["job"].tolist())}
    for seat, station in enumerate(seated["station"].tolist()):
        kind, cause = seated["kind"][seat], seated["cause"][seat]
        if kind == BLOCKED:
            wanted = route_of[seated.names["operation"][seated["operation"][seat]]]
            if station not in wanted and all(full[rank] for rank in wanted):
                yield seat, tuple(other for rank in wanted for other in seats[rank])
        elif kind == HELD and cause == NO_WORKER:
            able = [rank for rank, worker in enumerate(plan.workers) if worker.rating[station] > 0]
            if able and all(held.get(rank) in seat_of for rank in able):
                yield seat, tuple(seat_of[held[rank]] for rank in able)


def _stuck(needs: dict[int, tuple[int, ...]]) -> set[int]:
    """The greatest set of jobs each of which needs only jobs of the set."""
    stuck, before = set(needs), -1
    while len(stuck) != before:
        before = len(stuck)
        stuck = {seat for seat in stuck if stuck.issuperset(needs[seat])}
    return stuck


def _closed_rings(needs: dict[int, tuple[int, ...]], stuck: set[int]) -> Iterator[set[int]]:
    """Sets of jobs that all wait for each other and for nobody else."""
    reach = {seat: set(_followed(seat, needs)) for seat in stuck}
    seen: set[int] = set()
    for seat in stuck:
        if seat not in seen and all(reach[other] == reach[seat] for other in reach[seat]):
            seen |= reach[seat]
            yield reach[seat]


def _followed(seat: int, needs: dict[int, tuple[int, ...]]) -> list[int]:
    """All jobs that a job waits for, directly or through others, depth first."""
    found: dict[int, None] = {}
    ahead = [*reversed(needs[seat])]
    while ahead:
        other = ahead.pop()
        if other not in found:
            found[other] = None
            ahead.extend(reversed(needs[other]))
    return list(found)


def _ring(seated: EventLog, ring: set[int], needs: dict[int, tuple[int, ...]], plan: Plan) -> Locked:
    """The ring as people read it, from its first station in natural order along the waiting."""
    station, kind = seated["station"].tolist(), seated["kind"].tolist()
    first = min(ring, key=lambda seat: (station[seat], seat))
    order = dict.fromkeys(station[seat] for seat in (first, *_followed(first, needs)))
    short_of_hands = {station[seat] for seat in ring if kind[seat] == HELD}
    workers = tuple(w.name for w in plan.workers if any(w.rating[rank] > 0 for rank in short_of_hands))
    since_s = max(seated["start_s"][seat] for seat in ring)
    return Locked(tuple(plan.stations[rank].name for rank in order), float(since_s), workers)
