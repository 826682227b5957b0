"""The way of a product as it stands in the tree: the stations of a route, or those of a routing by probability."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.scenario.positions import Node, child, entries, items
from opsim.scenario.schema.routing import OUT, START

POINTS = ("stations", "stores", "conveyors")


def visited(tree: Node) -> set[str]:
    """The stations that some product goes to, if only for rework."""
    on_a_way = {name for product in entries(tree, "products").values() for name in stations_of(product)}
    reworks = (rework_at(station) for name, station in entries(tree, "stations").items() if name in on_a_way)
    return on_a_way | {rework.value for rework in reworks if rework is not None}


def rework_at(station: Node | None) -> Node | None:
    """Where the rework of a station's inspection is named, or None."""
    rework = child(station, "inspect", "then", "rework")
    return rework if rework is not None and isinstance(rework.value, str) else None


def stations_of(product: Node) -> set[str]:
    """The stations that a product goes to, those with probability 0 too."""
    in_route = {name for step in items(product, "route") for name in one_of(step)}
    routing = entries(product, "routing")
    in_routing = {name for row in routing.values() for name, _ in onward(row)} | set(routing)
    return in_route | in_routing - {START, OUT}


def first_of(product: Node) -> list[str]:
    """The stations at which a product may begin."""
    start = child(product, "routing", START)
    first = next(iter(items(product, "route")), None)
    if start is not None:
        return [name for name, _ in onward(start)]
    return [] if first is None else one_of(first)


def one_of(step: Node) -> list[str]:
    """The stations of a step: one, or the ones of which one does it."""
    return [node.value for node in [step, *items(step)] if isinstance(node.value, str)]


def onward(row: Node) -> Iterator[tuple[str, Node]]:
    """Where a job goes from a station of a routing, each with the node that says so."""
    if isinstance(row.value, str):
        yield row.value, row
    for name, probability in entries(row).items():
        yield name, Node(name, probability.name_place)


def points(tree: Node) -> dict[str, Node]:
    """The points of the flow: stations, stores and conveyors, which share their names."""
    return {name: node for section in POINTS for name, node in entries(tree, section).items()}
