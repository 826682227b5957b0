"""What stands where on a floor: the points of a layout with their stations and stores, its paths and belts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

Point = tuple[float, float]
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


def spots_of(plan: Any, layout: Any) -> tuple[Spot, ...]:
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


def belts_of(plan: Any, layout: Any) -> tuple[Stretch, ...]:
    """From where jobs get on to where they get off."""
    ends = [(plan.stations[belt.station].place, belt.place_to) for belt in plan.conveyors]
    return tuple((tuple(layout.places[plan.places[a]]), tuple(layout.places[plan.places[b]])) for a, b in ends)


def _standing(plan: Any) -> dict[str, list[tuple[str, str]]]:
    """(name, kind) of the stations and stores at each place that has some."""
    found: dict[str, list[tuple[str, str]]] = {}
    for station in plan.stations:
        if station.kind in (STATION, STORE):
            found.setdefault(plan.places[station.place], []).append((station.name, station.kind))
    return found


def _homes(plan: Any) -> set[str]:
    """Where people and vehicles begin."""
    return {plan.places[one.place] for one in (*plan.workers, *plan.transporters)}


def _names(here: list[tuple[str, str]]) -> tuple[str, ...]:
    """Of what stands there; of places only where nothing does."""
    things = [name for name, kind in here if kind != OTHER]
    return tuple(things or [name for name, _ in here])


def _kind(here: list[tuple[str, str]]) -> str:
    kinds = {kind for _, kind in here}
    return next((kind for kind in (STATION, STORE) if kind in kinds), OTHER)
