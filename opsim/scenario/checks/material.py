"""Shares must sum to 1, and a release must end."""

from __future__ import annotations

import math
from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import first_of
from opsim.scenario.positions import Node, child, entries, problem, text

MOST_AT_ONCE = 100_000
"""Jobs that a saturated release may make at t = 0."""


def material_problems(tree: Node) -> Iterator[Problem]:
    yield from _shares(tree)
    yield from _endless(tree)


def _shares(tree: Node) -> Iterator[Problem]:
    """The shares of the products sum to 1; one left out counts as 1."""
    products = entries(tree, "products")
    nodes = [child(product, "share") for product in products.values()]
    shares = [1.0 if node is None else node.value for node in nodes]
    if not shares or not all(
        isinstance(s, int | float) and not isinstance(s, bool) and math.isfinite(s) for s in shares
    ):
        return
    total = math.fsum(shares)
    if abs(total - 1.0) > 1e-6:
        unsaid = [name for name, node in zip(products, nodes) if node is None]
        hint = f"{unsaid[0]} has no share, which counts as 1" if unsaid and len(products) > 1 else ""
        place = tree.value["products"].name_place
        yield problem(place, ("products",), f"the shares sum to {total:g}; they must sum to 1", hint)


def _endless(tree: Node) -> Iterator[Problem]:
    """A saturated release fills the first buffer; one without a limit would never be full."""
    kind = child(tree, "release", "kind")
    if kind is None or kind.value != "saturated":
        return
    firsts = {name: product for product, node in entries(tree, "products").items() for name in first_of(node)}
    for name, product in firsts.items():
        station = child(tree, "stations", name)
        if station is None or not isinstance(station.value, dict):
            continue
        buffer = child(station, "buffer")
        if buffer is None or buffer.value is None or text(buffer) == "unlimited":
            place = station.name_place if buffer is None else buffer.place
            found = f"a saturated release into a buffer without limit (first of {shown(product)}) never ends"
            yield problem(place, ("stations", name, "buffer"), found, "give the buffer a number of places, such as 1")
        elif isinstance(buffer.value, int) and buffer.value > MOST_AT_ONCE:
            found = f"a saturated release would fill {buffer.value:,} places at once; at most {MOST_AT_ONCE:,}"
            yield problem(buffer.place, ("stations", name, "buffer"), found, "give the first buffer fewer places")
