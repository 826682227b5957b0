"""Points that can be full, and who keeps a place before he begins."""

from __future__ import annotations

from math import inf

from opsim.scenario.risks.ways import last_of
from opsim.scenario.schema import Card, Scenario


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
