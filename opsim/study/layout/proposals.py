"""First proposals: the stations put so that today's trips are short. They know nothing of queues; a simulation does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from opsim.study.layout.assign import Assignment, assigned, changes_step_by_step
from opsim.study.layout.floor import Floor, Movable
from opsim.study.layout.flows import Flows
from opsim.study.layout.moves import Candidate, changes_of

STEPS = 2
"""Proposals that change little, among the others: the best single change, and the best two."""


@dataclass(frozen=True)
class Proposals:
    """Layouts that shorten today's trips, the shortest first. exact : whether all ways to put the stations were tried.

    now_m_per_h, best_m_per_h : metres of today's trips, now and where they are the shortest that were found
    """

    candidates: tuple[Candidate, ...]
    exact: bool
    tried: int
    now_m_per_h: float
    best_m_per_h: float


def proposals(floor: Floor, free: Movable, flows: Flows, most: int, seed: int) -> Proposals:
    """At most so many layouts, by quadratic assignment of what stands at each place to places.

    Stations that stand at one place today stay together. What is not a station stays where it is.
    """
    names = flows.ways.places
    rank = {place: number for number, place in enumerate(names)}
    trips = flows.walked
    visited = [place for place in names if trips[rank[place]].any() or trips[:, rank[place]].any()]
    things = [*free.things, *(place for place in visited if place not in free.things)]
    spots = list(dict.fromkeys([*things, *free.allowed]))
    of, to = np.array([rank[place] for place in things]), np.array([rank[place] for place in spots])
    flow, distance = trips[np.ix_(of, of)], np.array(flows.ways.distance_m)[np.ix_(to, to)]
    asked: Any = {
        "now": list(range(len(things))),
        "fixed": list(range(len(free.things), len(things))),
        "allowed": [spots.index(place) for place in free.allowed],
    }
    steps = changes_step_by_step(flow, distance, **asked, steps=STEPS) if most > STEPS else []
    found = assigned(flow, distance, **asked, most=most + 1, seed=seed)
    now_m = float((flow * distance[: len(things), : len(things)]).sum())
    better = [one for one in found.best if one.cost < now_m * (1 - 1e-9) or free.exclusive]
    chosen = _chosen(better, steps, most)
    candidates = tuple(_candidate(floor, free, spots, one, number) for number, one in enumerate(chosen, 1))
    return Proposals(candidates, found.exact, found.tried, now_m, min([now_m, *(one.cost for one in better)]))


def _chosen(best: Sequence[Assignment], steps: Sequence[Assignment], most: int) -> list[Assignment]:
    """The cheapest, with room kept for those that change little; cheapest first."""
    few = [one for one in steps if all(one.cost > other.cost * (1 + 1e-9) for other in best[: most - len(steps)])]
    return sorted([*best[: most - len(few)], *few], key=lambda one: one.cost)


def _candidate(floor: Floor, free: Movable, spots: Sequence[str], one: Assignment, number: int) -> Candidate:
    goes = {place: spots[one.place_of[thing]] for thing, place in enumerate(free.things)}
    at = {station: goes.get(place, place) for station, place in floor.at.items()}
    return Candidate(f"proposal_{number}", changes_of(floor, at), at, proposed=True, predicted_m_per_h=one.cost)
