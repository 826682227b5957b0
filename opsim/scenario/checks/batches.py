"""Batches: as many jobs as they take can wait for each other, and no worker would have to carry them on."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import stations_of
from opsim.scenario.positions import Node, child, entries, problem


def batch_problems(tree: Node) -> Iterator[Problem]:
    """Buffers in which a batch never fills; jobs of a batch that one worker would have to carry."""
    for name, station in entries(tree, "stations").items():
        batch, buffer = child(station, "batch"), child(station, "buffer")
        if batch is None:
            continue
        size = child(batch, "size")
        if _whole(size) and _whole(buffer) and buffer.value < size.value:  # type: ignore[union-attr]
            found = f"a batch of {size.value} never comes together in a buffer of {buffer.value}"  # type: ignore[union-attr]
            hint = f"give the buffer at least {size.value} places"  # type: ignore[union-attr]
            yield problem(batch.name_place, ("stations", name, "batch"), found, hint)
        yield from _carried(tree, name)


def _carried(tree: Node, name: str) -> Iterator[Problem]:
    for product, node in entries(tree, "products").items():
        carried = child(node, "carried")
        if carried is not None and carried.value is True and name in stations_of(node):
            found = f"{shown(product)} comes to {shown(name)}, whose batches nobody can carry on"
            hint = "remove 'carried', or give the station no batch"
            yield problem(carried.place, ("products", product, "carried"), found, hint)


def _whole(node: Node | None) -> bool:
    return node is not None and isinstance(node.value, int) and not isinstance(node.value, bool)
