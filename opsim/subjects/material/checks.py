"""Bills of material and splits: of products that exist, at stations on the way, without going round in a circle.

Stores: at a place, at the end of ways, and at the start no fuller than they can be.

Loops of cards lie on the way of a product, from a point to a later one.

What lies in stores at the start holds cards: no more pieces than there are cards for them.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import pairwise

from opsim.layout import reached, rings
from opsim.plan import Plan
from opsim.problems import Assumption, Problem, did_you_mean, listed, natural_key, shown
from opsim.scenario.checks.lookup import first_of, named, one_of, onward, stations_of, whole_number
from opsim.scenario.checks.lookup import points as points_of
from opsim.scenario.tree import Node, Place, child, entries, items, problem
from opsim.subjects.routes.words import OUT, START

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


def store_problems(tree: Node) -> Iterator[Problem]:
    """Stores where nothing ends, in the middle of a way, or that hold at the start what cannot lie there."""
    stores, products = entries(tree, "stores"), entries(tree, "products")
    for name, store in stores.items():
        yield from named(child(store, "at"), entries(tree, "layout", "places"), "place", ("stores", name, "at"))
        ends = [product for product, node in products.items() if name in stations_of(node)]
        if not ends:
            found = f"the way of no product ends in the store {shown(name)}"
            yield problem(store.name_place, ("stores", name), found, f"let a route end in it: [..., {name}]")
        else:
            yield from _initial(name, store, ends)
    for name, product in products.items():
        yield from _middle(product, stores, ("products", name))


def _initial(name: str, store: Node, ends: list[str]) -> Iterator[Problem]:
    initial, capacity = child(store, "initial"), child(store, "capacity")
    if initial is None:
        return
    path = ("stores", name, "initial")
    by_product = entries(initial)
    if not by_product and len(ends) > 1 and initial.value:
        found = f"{' and '.join(sorted(ends))} end in {shown(name)}: of which are these?"
        yield problem(initial.place, path, found, f"write e.g. {{{ends[0]}: {initial.value}}}")
    for product, number in by_product.items():
        if product not in ends:
            found = f"no way of {shown(product)} ends in {shown(name)}"
            yield problem(number.name_place, (*path, product), found, did_you_mean(product, ends, otherwise="those do"))
    said = [whole_number(node) for node in by_product.values() or [initial]]
    numbers, room = [number for number in said if number is not None], whole_number(capacity)
    if room is not None and len(numbers) == len(said) and sum(numbers) > room:
        found = f"{sum(numbers)} lie here at the start, and {room} have room"
        yield problem(initial.place, path, found, "raise the capacity, or begin with less")


def _middle(product: Node, stores: dict[str, Node], path: tuple[str, ...]) -> Iterator[Problem]:
    """A store ends a way: nothing comes after it, and it stands by itself."""
    steps = items(product, "route")
    for number, step in enumerate(steps):
        store = next((name for name in one_of(step) if name in stores), None)
        if store is not None and items(step):
            found = f"a way ends in one store, and {shown(store)} stands among others"
            yield problem(step.place, (*path, "route", number), found, f"write {store} alone")
        elif store is not None and number < len(steps) - 1:
            found = f"what lies in the store {shown(store)} is taken as a part: no way leads on from it"
            yield problem(step.place, (*path, "route", number), found, "end the route here, or use a station's buffer")
    for name, row in entries(product, "routing").items():
        if name in stores and any(True for _ in onward(row)):
            found = f"what lies in the store {shown(name)} is taken as a part: no way leads on from it"
            yield problem(row.name_place, (*path, "routing", name), found, "remove the line")


def card_problems(tree: Node) -> Iterator[Problem]:
    """Loops between points that are not there, that nobody passes, or that only some of alternative stations have."""
    for name, card in entries(tree, "cards").items():
        wrong = list(_names(tree, card, ("cards", name)))
        yield from wrong or _passed(tree, card, ("cards", name))


def _names(tree: Node, card: Node, path: tuple[str, ...]) -> Iterator[Problem]:
    points, products = list(points_of(tree)), list(entries(tree, "products"))
    for key, known, what in (("from", points, "station"), ("to", points, "station"), ("products", products, "product")):
        for node in _said(card, key):
            yield from named(node, known, what, (*path, key))


def _passed(tree: Node, card: Node, path: tuple[str, ...]) -> Iterator[Problem]:
    begin, end, asked = (values(card, key) for key in ("from", "to", "products"))
    products = {name: node for name, node in entries(tree, "products").items() if not asked or name in asked}
    for name, product in products.items():
        for key, points in (("from", begin), ("to", end)):
            for step in items(product, "route"):
                here = one_of(step)
                if points and 0 < len(points.intersection(here)) < len(here):
                    hint = f"write {key}: [{', '.join(here)}]"
                    found = f"{name} may go to {' or '.join(here)}, and the loop has only some of them"
                    yield problem(_at(card, key), (*path, key), found, hint)
    if products and not any(passes(product, begin, end) for product in products.values()):
        who = f"no product of {', '.join(sorted(asked))}" if asked else "no product"
        if begin and end:
            found = f"{who} goes from {_or(begin)} to {_or(end)}"
        else:
            found = f"{who} comes to {_or(begin or end)}"
        yield problem(card.name_place, path, found, "a loop goes along the way of a product")


def passes(product: Node, begin: Collection[str], end: Collection[str]) -> bool:
    """Whether a product's way leads from one of some points to one of others; empty: its first ones, the way out."""
    graph, starts = _graph(product)
    here = [name for name in graph if _point(name) in begin] if begin else starts
    there = reached(graph, here)
    return any(_point(name) in end for name in there) if end else bool(there)


def _graph(product: Node) -> tuple[dict[str, list[str]], list[str]]:
    """Steps and the steps that follow; the n-th step of a route is called "n point", as a point may come again."""
    steps = [[f"{n} {name}" for name in one_of(step)] for n, step in enumerate(items(product, "route"))]
    graph: dict[str, list[str]] = {name: [] for step in steps for name in step}
    for here, there in pairwise(steps):
        graph.update(dict.fromkeys(here, there))
    for name, row in entries(product, "routing").items():
        if name not in (START, OUT):
            graph[f"0 {name}"] = [f"0 {other}" for other, _ in onward(row) if other != OUT]
    starts = steps[0] if steps else [f"0 {name}" for name in first_of(product)]
    return graph, [name for name in starts if name in graph]


def _point(step: str) -> str:
    return step.partition(" ")[2]


def _said(card: Node, key: str) -> list[Node]:
    node = child(card, key)
    return [] if node is None else items(node) or [node]


def values(card: Node, key: str) -> set[str]:
    """The names that a loop says at a key; empty where it says none."""
    return {node.value for node in _said(card, key) if isinstance(node.value, str)}


def _at(card: Node, key: str) -> Place:
    node = child(card, key)
    return card.name_place if node is None else node.place


def _or(names: Collection[str]) -> str:
    return " or ".join(shown(name) for name in sorted(names))


def card_stock_problems(tree: Node) -> Iterator[Problem]:
    """Loops with fewer cards than pieces that lie inside them at the start."""
    for name, card in entries(tree, "cards").items():
        n = child(card, "n")
        pieces, place = _inside(tree, card)
        if n is not None and isinstance(n.value, int) and place is not None and pieces > n.value > 0:
            found = f"{pieces} pieces lie inside the loop {shown(name)} at the start, which has {n.value} cards"
            yield problem(place, ("cards", name, "n"), found, f"give it at least {pieces}, or begin with less")


def _inside(tree: Node, card: Node) -> tuple[int, Place | None]:
    """The jobs in stores at the start that hold a card of a loop, and where the last of them are said."""
    begin, end, asked = (values(card, key) for key in ("from", "to", "products"))
    total, place = 0, None
    for store, block in entries(tree, "stores").items():
        if end and store not in end:
            continue
        for product, number, node in _initial_stock(tree, store, block):
            made = entries(tree, "products").get(product)
            if made is not None and (not asked or product in asked) and passes(made, begin, end):
                total, place = total + number, node.place
    return total, place


def _initial_stock(tree: Node, store: str, block: Node) -> Iterator[tuple[str, int, Node]]:
    """(product, jobs, node) of what lies in a store at the start; a number alone is of the product that ends there."""
    initial = child(block, "initial")
    if initial is None:
        return
    ends = [name for name, product in entries(tree, "products").items() if store in stations_of(product)]
    said = entries(initial) or dict.fromkeys(ends[:1], initial)
    for product, node in said.items():
        pieces = whole_number(node)
        if pieces is not None:
            yield product, pieces, node


def assumed_assembly(plan: Plan) -> Iterator[Assumption]:
    if plan.kits:
        where = listed(sorted({plan.stations[kit.station].name for kit in plan.kits}))
        yield (
            "parts",
            f"{where}: a job on its server takes all its parts at once, the oldest first; fetching takes no time",
        )
    if plan.splits:
        yield "parts", "pieces of a job that is split leave the server one by one, which is free when the last is gone"
    lots = [f"{product.name} ({product.lot})" for product in plan.products if product.lot > 1]
    if lots:
        yield "lots", f"{listed(lots)}: a lot moves as one, and is good or bad as one"
