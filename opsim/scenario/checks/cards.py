"""Loops of cards lie on the way of a product, from a point to a later one."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import pairwise

from opsim.graph import reached
from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.checks.ways import first_of, one_of, onward
from opsim.scenario.checks.ways import points as points_of
from opsim.scenario.positions import Node, Place, child, entries, items, problem
from opsim.scenario.schema.routing import OUT, START


def card_problems(tree: Node) -> Iterator[Problem]:
    """Loops between points that are not there, that nobody passes, or that only some of alternative stations have."""
    for name, card in entries(tree, "cards").items():
        wrong = list(_names(tree, card, ("cards", name)))
        yield from wrong or _passed(tree, card, ("cards", name))


def _names(tree: Node, card: Node, path: tuple[str, ...]) -> Iterator[Problem]:
    points, products = list(points_of(tree)), list(entries(tree, "products"))
    for key, known, what in (("from", points, "station"), ("to", points, "station"), ("products", products, "product")):
        for node in _said(card, key):
            if isinstance(node.value, str) and node.value not in known:
                hint = did_you_mean(node.value, known, otherwise=f"known {what}s")
                yield problem(node.place, (*path, key), f"no {what} {shown(node.value)}", hint)


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
