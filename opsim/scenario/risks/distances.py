"""Distances that are likely slips: centimetres for metres, two names for one point, ways shorter than straight."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import combinations
from math import dist, inf
from statistics import median

from opsim.names import natural_key
from opsim.scenario.risks.words import listed
from opsim.scenario.schema import Scenario

FAR = 20
"""Times as far from everything as places usually are from each other."""
FAR_M, NEAR_M = 50.0, 1.0
MOST_PLACES = 300
"""For which each is compared with every other one."""
STRAIGHT = 0.99
"""Of the straight line: what is shorter cannot be walked."""
LONG = 10
Places = Mapping[str, tuple[float, float]]


def distance_risks(scenario: Scenario) -> Iterator[str]:
    """Places far away or in one point, a layout the size of a table, ways of an impossible length."""
    places = scenario.layout.places
    if len(places) <= MOST_PLACES:
        yield from _far(places)
        yield from _one_point(places)
        yield from _tiny(places)
    yield from _lengths(scenario)


def _far(places: Places) -> Iterator[str]:
    nearest = {
        name: min((dist(at, places[o]) for o in places if o != name), default=0.0) for name, at in places.items()
    }
    usual = median(nearest.values()) if nearest else 0.0
    for name in sorted(places, key=natural_key):
        if nearest[name] > max(FAR * usual, FAR_M) and usual > 0:
            yield f"{name} is {nearest[name]:g} m from the nearest other place, others {usual:g} m: is it in metres?"


def _one_point(places: Places) -> Iterator[str]:
    names_at: dict[tuple[float, float], list[str]] = {}
    for name in sorted(places, key=natural_key):
        x, y = places[name]
        names_at.setdefault((x, y), []).append(name)
    for names in names_at.values():
        if len(names) > 1:
            yield f"{listed(names)} are in one and the same point: no way between them"


def _tiny(places: Places) -> Iterator[str]:
    widest = max((dist(a, b) for a, b in combinations(places.values(), 2)), default=inf)
    if len(places) > 2 and 0 < widest < NEAR_M:
        yield f"all places lie within {widest:g} m: are they in metres?"


def _lengths(scenario: Scenario) -> Iterator[str]:
    """Lengths that are given, against the straight line between the ends."""
    places = scenario.layout.places
    given = [("the path", way.start, way.end, way.length_m) for way in scenario.layout.path_steps]
    given += [(f"conveyor {name},", belt.start, belt.end, belt.length_m) for name, belt in scenario.conveyors.items()]
    for what, start, end, length_m in given:
        if length_m is None:
            continue
        straight_m = dist(places[start], places[end])
        said = f"{what} from {start} to {end} is {length_m:g} m long, the straight line {straight_m:g} m"
        if length_m < STRAIGHT * straight_m:
            yield f"{said}: nothing is shorter than straight"
        elif length_m > LONG * straight_m > 0:
            yield f"{said}: is it in metres?"
