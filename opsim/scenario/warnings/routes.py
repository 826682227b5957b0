"""The ways of products through the points of a scenario: stations, stores and conveyors.

Points that can be full, and who keeps a place before he begins.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise, product
from math import inf

from opsim.layout import reached, reverse
from opsim.scenario.schema import Card, Product, Scenario
from opsim.subjects.routes.words import OUT, START

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


def finite(scenario: Scenario) -> set[str]:
    """Points that can be full."""
    stations = {name for name, station in scenario.stations.items() if station.buffer is not None}
    stations |= {name for line in scenario.lines.values() for name in line.stations}
    return stations | {name for name in scenario.stores if _may_be_full(name, scenario)} | {*scenario.conveyors}


def _may_be_full(name: str, scenario: Scenario) -> bool:
    """Whether a store has a limit that neither its cards nor the levels of base stocks keep it below."""
    room = scenario.stores[name].capacity
    most = [_most(product, name, scenario) for product, made in scenario.products.items() if name in last_of(made)]
    return room is not None and sum(most) > room


def _most(product: str, store: str, scenario: Scenario) -> float:
    """The most jobs of a product that are in a store at once, or on the way to it."""
    limits: list[float] = [c.n for c in scenario.cards.values() if store in (c.end or ()) and needs_card(product, c)]
    pulls = [source.level or 0 for source in scenario.sources.values() if source.store == store]
    pushes = [s for s in scenario.sources.values() if s.store is None and product in (s.products or {product: 1.0})]
    if pulls and not pushes:
        limits.append(sum(pulls) // scenario.products[product].lot + 1)
    return min(limits, default=inf)


def needs_card(product: str, card: Card) -> bool:
    """Whether jobs of a product take a card of a loop."""
    return card.products is None or product in card.products


def keeps_place(scenario: Scenario, station: str) -> bool:
    """Whether jobs of a station begin only when their place further on is sure."""
    at = scenario.stations.get(station)
    return at is not None and (at.blocking or scenario.flow.blocking) == "before"
