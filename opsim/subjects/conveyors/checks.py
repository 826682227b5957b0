"""What is wrong with conveyors: their ends are places, and at least one job fits between them.

What the assumption sheet says.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot

from opsim.plan.plan import Plan
from opsim.problems import Problem, listed, shown
from opsim.scenario.checks.lookup import named
from opsim.scenario.checks.transport import metres
from opsim.scenario.tree import Node, child, entries, items, problem, text


def conveyor_problems(tree: Node) -> Iterator[Problem]:
    """Ends that are no places, and belts without a length that are too short for one job."""
    places = entries(tree, "layout", "places")
    for name, belt in entries(tree, "conveyors").items():
        for end in ("from", "to"):
            yield from named(child(belt, end), places, "place", ("conveyors", name, end))
        straight_m, pitch_m = _straight_m(belt, places), metres(child(belt, "pitch"))
        if child(belt, "length") is None and straight_m is not None and pitch_m is not None and straight_m < pitch_m:
            found = f"from {shown(text(belt, 'from'))} to {shown(text(belt, 'to'))} it is {straight_m:g} m: no room"
            yield problem(
                belt.name_place, ("conveyors", name), f"{found} for a job of {pitch_m:g} m", "add e.g. 'length: 6 m'"
            )


def _straight_m(belt: Node, places: dict[str, Node]) -> float | None:
    """The length of the straight line between the ends; None where it cannot be known."""
    at = [places.get(text(belt, end) or "") for end in ("from", "to")]
    ends = [items(place) or items(place, "at") for place in at]
    points = [[metres(coordinate) for coordinate in end] for end in ends]
    if any(len(point) != 2 or None in point for point in points):
        return None
    (x, y), (u, v) = points
    return hypot(x - u, y - v)  # type: ignore[operator]


def belts(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of conveyors."""
    if plan.conveyors:
        names = listed([plan.stations[belt.station].name for belt in plan.conveyors])
        yield "transport", f"{names}: belts run all the time, and never break"
