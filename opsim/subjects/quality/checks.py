"""Rework: it goes to a station that is there, and not to one that is still to come.

What the assumption sheet says of defects.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from opsim.plan import Plan
from opsim.problems import Assumption, Problem, shown
from opsim.scenario.checks.lookup import named, one_of, rework_at
from opsim.scenario.tree import Node, Part, entries, items, problem


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


def assumed_quality(plan: Plan) -> Iterator[Assumption]:
    for one in plan.quality:
        name = plan.stations[one.station].name
        if one.yield_share < 1:
            yield "quality", f"{name}: {one.yield_share:.4g} of its operations leave no defect, each by chance alone"
        if one.inspects and (one.finds < 1 or one.false_alarms > 0):
            alarms = f", and {one.false_alarms:.4g} of good ones is held to be bad" if one.false_alarms else ""
            yield "quality", f"{name}: {one.finds:.4g} of bad jobs is found to be bad{alarms}"
        if one.back:
            often = "as often as it takes" if one.most == inf else f"at most {one.most:g} times, then it is scrap"
            yield (
                "quality",
                f"{name}: a job is reworked {often}; it is good then until an operation leaves a defect anew",
            )
    unseen = not any(one.inspects for one in plan.quality)
    if plan.quality and unseen:
        yield "quality", "nobody inspects: jobs with a defect go on and out, and are not counted as good"
    elif any(one.yield_share < 1 for one in plan.quality):
        yield "quality", "throughput counts good jobs only: one that leaves with a defect nobody found is not in it"
