"""Who carries a product can lift one piece of it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from opsim import units
from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import one_of, onward
from opsim.scenario.positions import Node, child, entries, items, problem
from opsim.scenario.schema.routing import OUT, START


def carrying_problems(tree: Node) -> Iterator[Problem]:
    """Workers who may have to carry a piece that is heavier than what they carry."""
    legs = _legs(tree)
    for made, product in entries(tree, "products").items():
        carried, mass_kg = child(product, "carried"), _kg(child(product, "mass"))
        if carried is None or carried.value is not True or mass_kg is None:
            continue
        froms = {before for before, after in _moves(product) if (before, after) not in legs}
        for name, worker in entries(tree, "workers").items():
            limit = child(worker, "most_load")
            most_kg = _kg(limit)
            station = next((station for station in entries(worker, "skills") if station in froms), None)
            if limit is not None and most_kg is not None and 0 < most_kg < mass_kg and station is not None:
                found = f"{name} may have to carry {shown(made)} ({mass_kg:g} kg) on from {shown(station)}"
                hint = "let a transporter bring it, or somebody stronger work there"
                yield problem(limit.place, ("workers", name, "most_load"), f"{found}, and cannot lift it", hint)


def _moves(product: Node) -> Iterator[tuple[str, str]]:
    """(from, to) of all that jobs of the product are carried between."""
    steps = [one_of(step) for step in items(product, "route")]
    for here, there in pairwise(steps):
        yield from ((before, after) for before in here for after in there)
    for before, row in entries(product, "routing").items():
        if before != START:
            yield from ((before, after) for after, _ in onward(row) if after != OUT)


def _legs(tree: Node) -> set[tuple[str, str]]:
    found = [leg.plain() for one in entries(tree, "transporters").values() for leg in items(one, "legs")]
    return {(leg[0], leg[1]) for leg in found if isinstance(leg, list) and len(leg) == 2 and _words(leg)}


def _words(leg: list) -> bool:
    return all(isinstance(end, str) for end in leg)


def _kg(node: Node | None) -> float | None:
    try:
        return None if node is None else units.parse(node.value, "mass")
    except units.UnitError:
        return None
