"""Transporters: what they bring jobs between exists, nobody else brings them there, and roads lead there.

Conveyors: their ends are places, and at least one job fits between them.

Who carries a product can lift one piece of it.

Tools that are needed exist, there are enough of them, and are held between moments that exist.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise
from math import hypot
from pathlib import Path

from opsim import units
from opsim.layout import Graph, reached, reverse
from opsim.problems import Problem, shown
from opsim.scenario.checks.lookup import named, one_of, onward, path_problems, points
from opsim.scenario.checks.motions import moment_problems
from opsim.scenario.checks.routes import graph_of
from opsim.scenario.schema.routing import OUT, START
from opsim.scenario.tree import Node, Part, child, entries, items, problem, text

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


def conveyor_problems(tree: Node) -> Iterator[Problem]:
    """Ends that are no places, and belts without a length that are too short for one job."""
    places = entries(tree, "layout", "places")
    for name, belt in entries(tree, "conveyors").items():
        for end in ("from", "to"):
            yield from named(child(belt, end), places, "place", ("conveyors", name, end))
        straight_m, pitch_m = _straight_m(belt, places), _metres(child(belt, "pitch"))
        if child(belt, "length") is None and straight_m is not None and pitch_m is not None and straight_m < pitch_m:
            found = f"from {shown(text(belt, 'from'))} to {shown(text(belt, 'to'))} it is {straight_m:g} m: no room"
            yield problem(
                belt.name_place, ("conveyors", name), f"{found} for a job of {pitch_m:g} m", "add e.g. 'length: 6 m'"
            )


def _straight_m(belt: Node, places: dict[str, Node]) -> float | None:
    """The length of the straight line between the ends; None where it cannot be known."""
    at = [places.get(text(belt, end) or "") for end in ("from", "to")]
    ends = [items(place) or items(place, "at") for place in at]
    points = [[_metres(coordinate) for coordinate in end] for end in ends]
    if any(len(point) != 2 or None in point for point in points):
        return None
    (x, y), (u, v) = points
    return hypot(x - u, y - v)  # type: ignore[operator]


def _metres(node: Node | None) -> float | None:
    try:
        return None if node is None else units.parse(node.value, "length")
    except units.UnitError:
        return None


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


def tool_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Tools that are named and do not exist, wants that can never be met, and marks that no movement has."""
    tools = entries(tree, "tools")
    for section in ("stations", "tasks"):
        for name, block in entries(tree, section).items():
            for tool, number in entries(block, "needs").items():
                yield from named(Node(tool, number.name_place), tools, "tool", (section, name, "needs", tool))
    for name, task in entries(tree, "tasks").items():
        yield from named(child(task, "hold", "tool"), tools, "tool", ("tasks", name, "hold", "tool"))
        yield from moment_problems(tree, task, ("tasks", name, "hold"), folder)
    if tools:
        yield from _too_few(tree)
    yield from _set_ups(tree)


def _too_few(tree: Node) -> Iterator[Problem]:
    """A station where one job would need more of a tool than there are: it would wait for ever."""
    counts = {tool: _whole(child(node, "n"), 1) for tool, node in entries(tree, "tools").items()}
    there = {tool: n for tool, n in counts.items() if n > 0}  # the others are told of by the schema
    for name, station in entries(tree, "stations").items():
        for task, wanted in _wanted(tree, station):
            short = next((tool for tool in wanted if tool in there and wanted[tool] > there[tool]), None)
            if short is not None:
                who = f"a job at {name}" if task is None else f"a job at {name} in task {task}"
                found = f"{who} needs {wanted[short]} of {shown(short)}, and there {_are(there[short])}"
                hint = f"write 'tools: {{{short}: {{n: {wanted[short]}}}}}', or need fewer"
                yield problem(station.name_place, ("stations", name), found, hint)
                break


def _wanted(tree: Node, station: Node) -> Iterator[tuple[str | None, Counter[str]]]:
    """What one job has of each tool: at the station alone, and in each of its tasks besides."""
    always = _needs(station)
    yield None, always
    for node in items(station, "tasks"):
        task = child(tree, "tasks", node.value) if isinstance(node.value, str) else None
        if task is not None:
            held = text(task, "hold", "tool")
            yield node.value, always + _needs(task) + Counter([held] if held else [])


def _needs(block: Node) -> Counter[str]:
    return Counter({tool: _whole(number, 0) for tool, number in entries(block, "needs").items()})


def _whole(node: Node | None, otherwise: int) -> int:
    return node.value if node is not None and type(node.value) is int else otherwise


def _are(n: int) -> str:
    return "is 1" if n == 1 else f"are {n}"


def _set_ups(tree: Node) -> Iterator[Problem]:
    """Set-ups that are tasks of a team, or with tools of their own."""
    for name, station in entries(tree, "stations").items():
        setup = child(station, "setup")
        times: list[tuple[tuple[str, ...], Node | None]] = [(("otherwise",), child(setup, "otherwise"))]
        for before, row in entries(setup, "times").items():
            times += [(("times", before, after), node) for after, node in entries(row).items()]
        for path, node in times:
            task = child(tree, "tasks", node.value) if node is not None and isinstance(node.value, str) else None
            key = next((key for key in ("team", "needs", "hold") if child(task, key) is not None), None)
            if key is not None and node is not None:
                found = f"{shown(node.value)} has {key!r}, and a set-up is done by one worker without tools of its own"
                hint = "let the station need the tools" if key != "team" else ""
                yield problem(node.place, ("stations", name, "setup", *path), found, hint)
