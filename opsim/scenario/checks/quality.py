"""Rework: it goes to a station that is there, and not to one that is still to come."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.references import named
from opsim.scenario.checks.ways import one_of, rework_at
from opsim.scenario.positions import Node, Part, entries, items, problem


def quality_problems(tree: Node) -> Iterator[Problem]:
    """Rework at stations that do not exist, or that a product comes to only after the inspection."""
    stations = entries(tree, "stations")
    for name, station in stations.items():
        rework, path = rework_at(station), ("stations", name, "inspect", "then", "rework")
        if rework is None:
            continue
        yield from named(rework, stations, "station", path)
        for made, product in entries(tree, "products").items():
            yield from _still_to_come(name, rework, made, product, path)


def _still_to_come(name: str, rework: Node, made: str, product: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """A route on which the rework station stands behind the inspection alone."""
    steps = [one_of(step) for step in items(product, "route")]
    looked_at = [number for number, step in enumerate(steps) if name in step]
    mended = [number for number, step in enumerate(steps) if rework.value in step]
    if looked_at and mended and mended[0] > looked_at[0]:
        found = f"{shown(made)} comes to {shown(rework.value)} only after {name}: nothing can go back there"
        hint = "name a station before it, or one that is on no way of the product"
        yield problem(rework.place, path, found, hint)
