"""The ways of products through the points of a scenario: stations, stores and conveyors."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise, product

from opsim.graph import reached, reverse
from opsim.scenario.schema import Product, Scenario
from opsim.scenario.schema.routing import OUT, START

Ways = dict[str, set[str]]
"""Where jobs may go from each point."""


def ways(scenario: Scenario, only_carried: bool = False) -> Ways:
    """Where jobs of any product may go from each point."""
    found: Ways = {}
    for made in scenario.products.values():
        if made.carried or not only_carried:
            for here, onward in way_of(made, scenario).items():
                found.setdefault(here, set()).update(onward)
    return found


def way_of(made: Product, scenario: Scenario) -> Ways:
    """Where jobs of a product may go from each point; from where they are split, to where the pieces begin."""
    found: Ways = {}
    for here, there in pairwise(made.route or ()):
        for a, b in product(one_of(here), one_of(there)):
            found.setdefault(a, set()).add(b)
    for here, onward in (made.routing or {}).items():
        if here != START:
            found.setdefault(here, set()).update(set(onward) - {OUT})
    for here, pieces in made.split.items():
        for piece in pieces:
            found.setdefault(here, set()).update(first_of(scenario.products[piece]))
    for here in points_of(made):  # sent back to be done again
        rework = _rework(here, scenario)
        if rework is not None:
            found.setdefault(here, set()).add(rework)
            if rework not in points_of(made):
                found.setdefault(rework, set()).add(here)
    return found


def points_of(made: Product) -> list[str]:
    """The points that a product comes by."""
    in_route = [name for step in made.route or () for name in one_of(step)]
    routing = made.routing or {}
    in_routing = {*routing, *(name for row in routing.values() for name in row)} - {START, OUT}
    return list(dict.fromkeys([*in_route, *sorted(in_routing)]))


def _rework(point: str, scenario: Scenario) -> str | None:
    """The station to which jobs are sent back from a point."""
    station = scenario.stations.get(point)
    return None if station is None or station.inspect is None else station.inspect.rework


def first_of(made: Product) -> list[str]:
    """The points at which a product may begin."""
    return list(made.routing[START]) if made.routing is not None else one_of((made.route or [[]])[0])


def last_of(made: Product) -> list[str]:
    """The points at which a product may end."""
    if made.routing is not None:
        return [name for name, row in made.routing.items() if OUT in row]
    return one_of((made.route or [[]])[-1])


def between(way: Ways, starts: Iterable[str], ends: Iterable[str]) -> set[str]:
    """The points on the way from some to others, both included."""
    return reached(way, starts) & reached(reverse(way), ends)


def one_of(step: str | list[str]) -> list[str]:
    """The stations of a step: one, or those of which one does it."""
    return [step] if isinstance(step, str) else step
