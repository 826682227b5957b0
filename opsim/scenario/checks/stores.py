"""Stores: at a place, at the end of ways, and at the start no fuller than they can be."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.references import named
from opsim.scenario.checks.ways import one_of, onward, stations_of
from opsim.scenario.positions import Node, child, entries, items, problem


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
    numbers = [node.value for node in by_product.values()] or [initial.value]
    known = capacity is not None and all(_whole(number) for number in (capacity.value, *numbers))
    if known and sum(numbers) > capacity.value:  # type: ignore[union-attr]
        found = f"{sum(numbers)} lie here at the start, and {capacity.value} have room"  # type: ignore[union-attr]
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


def _whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)
