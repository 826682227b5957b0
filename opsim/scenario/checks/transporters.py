"""Transporters: what they bring jobs between exists, nobody else brings them there, and roads lead there."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.graph import Graph, reached, reverse
from opsim.problems import Problem, shown
from opsim.scenario.checks.references import named, path_problems
from opsim.scenario.checks.walking import graph_of
from opsim.scenario.checks.ways import points
from opsim.scenario.positions import Node, Part, child, entries, items, problem, text

Leg = tuple[str | None, str | None]


def transporter_problems(tree: Node) -> Iterator[Problem]:
    """Names that lead nowhere, legs that lead back or are served twice, and stops that no road leads to."""
    places, stations = entries(tree, "layout", "places"), points(tree)
    served: dict[Leg, str] = {}
    for name, vehicle in entries(tree, "transporters").items():
        path = ("transporters", name)
        yield from named(child(vehicle, "at"), places, "place", (*path, "at"))
        yield from path_problems(items(vehicle, "roads"), places, (*path, "roads"))
        for number, leg in enumerate(items(vehicle, "legs")):
            for end in items(leg):
                yield from named(end, stations, "station", (*path, "legs", number))
            yield from _leg(leg, name, served, (*path, "legs", number))
        yield from _roads(tree, vehicle, path)


def _leg(leg: Node, name: str, served: dict[Leg, str], path: tuple[Part, ...]) -> Iterator[Problem]:
    ends = tuple(text(end) for end in items(leg))
    if len(ends) != 2 or None in ends:
        return
    before, after = ends
    if before == after:
        yield problem(leg.place, path, f"a leg from {shown(before)} to itself", "such as [drill, paint]")
    if (before, after) in served:
        found = f"{served[before, after]} already goes from {shown(before)} to {shown(after)}"
        yield problem(leg.place, path, found, "one kind of vehicle goes a leg")
    served.setdefault((before, after), name)


def _roads(tree: Node, vehicle: Node, path: tuple[str, ...]) -> Iterator[Problem]:
    """Stops that the vehicles cannot reach, or not come back from: each said once."""
    roads = child(vehicle, "roads")
    ways = child(tree, "layout", "paths") if roads is None and text(tree, "layout", "distance") == "paths" else roads
    if ways is None or not isinstance(ways.value, list):
        return
    what, where = ("path", vehicle.name_place) if roads is None else ("road", ways.name_place)
    for start, end in _not_led(tree, vehicle, graph_of(ways)):
        found = f"no {what} leads from {shown(start)} to {shown(end)}, and {path[1]} has to drive there"
        yield problem(where, path if roads is None else (*path, "roads"), found, _hint(graph_of(ways), start, end))


def _not_led(tree: Node, vehicle: Node, graph: Graph) -> Iterator[tuple[str, str]]:
    """(from, to) of what the vehicles must drive and cannot; ways between all stops, seen from the first."""
    known, home = entries(tree, "layout", "places"), text(vehicle, "at")
    stops = [stop for leg in items(vehicle, "legs") for stop in _stops(tree, leg) if stop in known]
    if not stops or home not in known:
        return
    first = stops[0]
    there, here = reached(graph, [first]), reached(reverse(graph), [first])
    goes_home = text(vehicle, "idle") == "home"
    for stop in dict.fromkeys([*stops, home]):
        if stop not in there and (stop in stops or goes_home):
            yield first, stop
        if stop not in here:
            yield stop, first


def _stops(tree: Node, leg: Node) -> Iterator[str]:
    """The places where jobs of a leg are loaded and unloaded; a conveyor's are its two ends."""
    for end, key in zip(items(leg), ("to", "from")):
        node = points(tree).get(text(end) or "")
        place = text(node, "at") or text(node, key)
        if place is not None:
            yield place


def _hint(graph: Graph, *places: str) -> str:
    back = reverse(graph)
    cut_off = next((place for place in places if not graph.get(place) and not back.get(place)), None)
    return "is a road missing, or 'one_way' too much?" if cut_off is None else f"add e.g. [{cut_off}, ...]"
