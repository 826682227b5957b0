"""Bills of material and splits: of products that exist, at stations on the way, without going round in a circle."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.graph import rings
from opsim.names import natural_key
from opsim.problems import Problem, shown
from opsim.scenario.checks.references import named
from opsim.scenario.checks.ways import one_of, onward, stations_of
from opsim.scenario.positions import Node, entries, items, problem
from opsim.scenario.schema.routing import OUT

_WHAT = {"parts": "where parts go in", "split": "where it is split"}


def assembly_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with ``parts`` and ``split`` of products."""
    products, stores = entries(tree, "products"), entries(tree, "stores")
    for name, product in products.items():
        for key in _WHAT:
            for station, pieces in entries(product, key).items():
                path = ("products", name, key, station)
                yield from _station(tree, name, product, key, station, pieces.name_place, path)
                for piece, number in entries(pieces).items():
                    yield from named(Node(piece, number.name_place), products, "product", (*path, piece))
                    if key == "parts" and piece in products and stations_of(products[piece]).isdisjoint(stores):
                        found = f"no {shown(piece)} can be taken as a part: its way ends in no store"
                        hint = f"let its route end in a store: [..., {next(iter(stores), piece + 's')}]"
                        yield problem(number.name_place, (*path, piece), found, hint)
        for station, pieces in entries(product, "split").items():
            yield from _goes_on(name, product, station, pieces)
    yield from _circles(products, "parts", "the bill of material goes round in a circle", "needs")
    yield from _circles(products, "split", "splitting never comes to an end", "becomes")


def _station(tree: Node, name: str, product: Node, key: str, station: str, place, path) -> Iterator[Problem]:
    """A station that exists and that no job of the product passes by."""
    stations = entries(tree, "stations")
    if station not in stations:
        yield from named(Node(station, place), stations, "station", path)
        return
    if station not in stations_of(product):
        found = f"the way of {shown(name)} skips {shown(station)}, {_WHAT[key]}"
        yield problem(place, path, found, f"add {station} to its route, or name the station that is meant")
        return
    here = entries(product, key, station)
    for step in items(product, "route"):
        for other in one_of(step):
            if station in one_of(step) and _plain(entries(product, key, other)) != _plain(here):
                found = f"a job that goes to {shown(other)} instead would skip {shown(station)}, {_WHAT[key]}"
                yield problem(place, path, found, f"say the same for {other}")


def _goes_on(name: str, product: Node, station: str, pieces: Node) -> Iterator[Problem]:
    """After a split there is nothing left that could go on."""
    steps = [one_of(step) for step in items(product, "route")]
    later = [other for number, step in enumerate(steps[:-1]) if station in step for other in steps[number + 1]]
    row = entries(product, "routing").get(station)
    later += [] if row is None else [other for other, _ in onward(row) if other != OUT]
    if later:
        found = f"after {shown(station)} there is no {shown(name)} any more, and its way goes on to {shown(later[0])}"
        hint = f"end its way at {station}: the pieces go the ways of their products"
        yield problem(pieces.name_place, ("products", name, "split", station), found, hint)


def _circles(products: dict[str, Node], key: str, what: str, verb: str) -> Iterator[Problem]:
    graph = {name: _pieces(product, key) & set(products) for name, product in products.items()}
    for ring in rings(graph):
        first = min(ring, key=natural_key)
        way = [first]
        while (after := min(graph[way[-1]] & ring, key=lambda one: (one in way, natural_key(one)))) not in way:
            way.append(after)
        round_trip = f" {verb} ".join([*way[way.index(after) :], after])
        hint = f"take {after} out of 'products.{way[-1]}.{key}', or break the circle elsewhere"
        yield problem(entries(products[first])[key].name_place, ("products", first, key), f"{what}: {round_trip}", hint)


def _pieces(product: Node, key: str) -> set[str]:
    return {piece for pieces in entries(product, key).values() for piece in entries(pieces)}


def _plain(by_product: dict[str, Node]) -> dict[str, object]:
    return {product: number.plain() for product, number in by_product.items()}
