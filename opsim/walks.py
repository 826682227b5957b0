"""The walks of a replication: whose, the how many-th, how far, and from when to when."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from opsim.clock import TICKS_PER_S
from opsim.log import WALK, EventLog
from opsim.plan import Plan


@dataclass(frozen=True)
class Walks:
    """All walks of a replication by worker and time, each (R,): item ``k`` is a worker's k-th walk, from 0.

    whole_s : what the walk takes to its end; one that the horizon cuts off ends before
    """

    worker: np.ndarray
    k: np.ndarray
    place_from: np.ndarray
    place_to: np.ndarray
    distance_m: np.ndarray
    start_s: np.ndarray
    end_s: np.ndarray
    whole_s: np.ndarray


def walks_of(log: EventLog, plan: Plan) -> Walks:
    """The walks behind the rows of one replication."""
    rows = walk_rows(log)
    worker, place_from, place_to = (log[name][rows] for name in ("worker", "place_from", "place_to"))
    first = np.searchsorted(worker, worker)
    speed_m_per_s = np.array([person.walk_m_per_s for person in plan.workers])[worker]
    distance_m = ways_m(log, plan, rows, speed_m_per_s)
    return Walks(
        worker,
        np.arange(rows.size) - first,
        place_from,
        place_to,
        distance_m,
        log["start_s"][rows],
        log["end_s"][rows],
        on_grid_each(distance_m / speed_m_per_s),
    )


def walk_rows(log: EventLog) -> np.ndarray:
    """(R,) rows of the log in which somebody walks, by worker and time."""
    rows = np.flatnonzero((log["kind"] == WALK) & (log["worker"] >= 0))
    return rows[np.lexsort([log["start_s"][rows], log["worker"][rows]])]


def ways_m(log: EventLog, plan: Plan, rows: np.ndarray, speed_m_per_s: np.ndarray) -> np.ndarray:
    """(n,) metres of each of some walks; along a moving line, where the place stays the same, as far as the time goes.

    speed_m_per_s : (n,) of who walks
    """
    place_from, place_to = log["place_from"][rows], log["place_to"][rows]
    way_m = np.array(plan.distance_m)[place_from, place_to]
    if not any(line.moves for line in plan.lines):
        return way_m
    return np.where(place_from == place_to, log.duration_s[rows] * speed_m_per_s, way_m)


def on_grid_each(seconds: np.ndarray) -> np.ndarray:
    """(n,) as ``opsim.clock.on_grid`` rounds each: a walk as the engine takes it."""
    return np.maximum(1.0, np.rint(seconds * TICKS_PER_S)) / TICKS_PER_S
