"""Lines along the axes of a floor, laid one after the other, each a little beside those that are there already.

What stands where on a floor: the points of a layout with their stations and stores, its paths and belts.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import hypot, inf
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from opsim.plan import Plan

Point = tuple[float, float]
BESIDE = (0.0, 7.0, -7.0, 13.0, -13.0)
"""Pixels that a line may run beside the straight way."""
THROUGH, NEAR, OFF = 60.0, 2.0, 1.5
"""What running through a mark costs, and a pixel beside the straight way, in pixels of hidden line; free space kept."""


class Laid:
    """Lines of people's ways. marks : (M, 2) middles of what stands on the floor, half_px : of a mark

    Of the two ways round the corner, and of some lanes beside each, the one is taken that hides least.
    """

    def __init__(self, marks: Sequence[Point], half_px: float) -> None:
        self._marks = np.array(marks, dtype=float).reshape(-1, 2)
        self._half = half_px
        self._drawn: tuple[list[tuple[float, ...]], list[tuple[float, ...]]] = ([], [])

    def line(self, start: Point, end: Point, width: float) -> list[Point]:
        """The corners of a line, which is drawn from now on."""
        drawn = tuple(np.array(pieces, dtype=float).reshape(-1, 4) for pieces in self._drawn)
        apart = (np.abs(self._marks - start).max(axis=1) > 1) & (np.abs(self._marks - end).max(axis=1) > 1)
        others, best, least = self._marks[apart], [start, end], inf
        for beside, corners in _offers(start, end):
            if OFF * abs(beside) >= least:  # NOTE: what lies further beside cannot be better
                break
            cost = OFF * abs(beside) + self._hidden(corners, width, drawn, others)
            if cost < least - 1e-6:
                best, least = corners, cost
        for axis, across, low, high in _pieces(best):
            self._drawn[axis].append((across, low, high, width))
        return best

    def _hidden(self, corners: Sequence[Point], width: float, drawn: Sequence[np.ndarray], others: np.ndarray) -> float:
        hidden = 0.0
        for axis, across, low, high in _pieces(corners):
            there = drawn[axis]
            shared = np.minimum(high, there[:, 2]) - np.maximum(low, there[:, 1])
            near = 1 - np.abs(there[:, 0] - across) / ((width + there[:, 3]) / 2 + NEAR)
            hidden += float((shared.clip(0.0) * near.clip(0.0)).sum())
            half = self._half + width / 2
            beside = np.abs(others[:, 1 - axis] - across) < half
            hidden += THROUGH * int((beside & (others[:, axis] > low - half) & (others[:, axis] < high + half)).sum())
        return hidden


def _offers(start: Point, end: Point) -> Iterator[tuple[float, list[Point]]]:
    """(how far beside, corners)"""
    (x, y), (u, v) = start, end
    for o in BESIDE:
        if abs(y - v) < 1:
            yield o, _plain([(x, y), (x, y + o), (u, y + o), (u, v)])
        elif abs(x - u) < 1:
            yield o, _plain([(x, y), (x + o, y), (x + o, v), (u, v)])
        else:
            yield o, _plain([(x, y), (x, y + o), (u + o, y + o), (u + o, v), (u, v)])
            yield o, _plain([(x, y), (x + o, y), (x + o, v + o), (u, v + o), (u, v)])


def _plain(corners: Sequence[Point]) -> list[Point]:
    """Without corners at which nothing turns."""
    return [corner for before, corner in pairwise([None, *corners]) if corner != before and corner is not None]


def _pieces(corners: Sequence[Point]) -> Iterator[tuple[int, float, float, float]]:
    """(axis along which it runs, where across, from, to) of each piece."""
    for a, b in pairwise(corners):
        axis = 0 if abs(b[0] - a[0]) >= abs(b[1] - a[1]) else 1
        yield axis, a[1 - axis], min(a[axis], b[axis]), max(a[axis], b[axis])


def rounded(corners: Sequence[Point], most: float = 8.0) -> str:
    """The ``d`` of a path through corners, each a little rounded."""
    drawn = "M{:.1f} {:.1f}".format(*corners[0])
    for a, b, c in zip(corners, corners[1:], corners[2:]):
        before, after = (_towards(b, other, most) for other in (a, c))
        drawn += "L{:.1f} {:.1f}Q{:.1f} {:.1f} {:.1f} {:.1f}".format(*before, *b, *after)
    return drawn + "L{:.1f} {:.1f}".format(*corners[-1])


def _towards(start: Point, end: Point, most: float) -> Point:
    """So far on the way, but at most half of it."""
    long = hypot(end[0] - start[0], end[1] - start[1])
    part = min(most / long, 0.5) if long else 0.0
    return start[0] + (end[0] - start[0]) * part, start[1] + (end[1] - start[1]) * part


Stretch = tuple[Point, Point]
STATION, STORE, OTHER = "station", "store", "other"


@dataclass(frozen=True, slots=True)
class Spot:
    """A point of the floor, in metres. names : of what stands there, or else what the place is called; none for a
    crossing"""

    at: Point
    names: tuple[str, ...]
    kind: str = OTHER

    @property
    def name(self) -> str:
        return ", ".join(self.names)


def spots_of(plan: Plan, layout: Any) -> tuple[Spot, ...]:
    """One for each point, in the natural order of its places; what is only passed on a path has no name."""
    standing = _standing(plan)
    passed = {name for step in layout.path_steps for name in (step.start, step.end)}
    crossings = passed - set(standing) - _homes(plan)
    found: dict[Point, list[tuple[str, str]]] = {}
    for place in plan.places:
        here = standing.get(place) or ([] if place in crossings else [(place, OTHER)])
        found.setdefault(tuple(layout.places[place]), []).extend(here)
    return tuple(Spot(point, _names(here), _kind(here)) for point, here in found.items())


def roads_of(layout: Any) -> tuple[Stretch, ...]:
    """The stretches of the paths."""
    ends = [(layout.places[step.start], layout.places[step.end]) for step in layout.path_steps]
    return tuple(dict.fromkeys((tuple(a), tuple(b)) for a, b in ends))


def belts_of(plan: Plan, layout: Any) -> tuple[Stretch, ...]:
    """From where jobs get on to where they get off."""
    ends = [(plan.stations[belt.station].place, belt.place_to) for belt in plan.conveyors]
    return tuple((tuple(layout.places[plan.places[a]]), tuple(layout.places[plan.places[b]])) for a, b in ends)


def _standing(plan: Plan) -> dict[str, list[tuple[str, str]]]:
    """(name, kind) of the stations and stores at each place that has some."""
    found: dict[str, list[tuple[str, str]]] = {}
    for station in plan.stations:
        if station.kind in (STATION, STORE):
            found.setdefault(plan.places[station.place], []).append((station.name, station.kind))
    return found


def _homes(plan: Plan) -> set[str]:
    """Where people and vehicles begin."""
    places = (*(worker.place for worker in plan.workers), *(vehicle.place for vehicle in plan.transporters))
    return {plan.places[place] for place in places}


def _names(here: list[tuple[str, str]]) -> tuple[str, ...]:
    """Of what stands there; of places only where nothing does."""
    things = [name for name, kind in here if kind != OTHER]
    return tuple(things or [name for name, _ in here])


def _kind(here: list[tuple[str, str]]) -> str:
    kinds = {kind for _, kind in here}
    return next((kind for kind in (STATION, STORE) if kind in kinds), OTHER)
