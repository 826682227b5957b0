"""Transporters: what they bring jobs between exists, nobody else brings them there, and roads lead there.

Conveyors: their ends are places, and at least one job fits between them. Who carries a product can lift a piece of it.

With a network of paths, a worker must be able to walk wherever the work is.

What is risky: places far away or in one point. What the assumption sheet says of transport.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from itertools import combinations, pairwise
from math import dist, inf
from statistics import median

from opsim.layout import Graph, reached, reverse, rings
from opsim.plan import Plan
from opsim.problems import Assumption, Problem, enumerated, listed, natural_key, shown
from opsim.scenario.checks.lookup import named, one_of, onward, path_problems, points, quantity, rework_at, stations_of
from opsim.scenario.schema import Scenario
from opsim.scenario.tree import Node, Part, child, entries, items, problem, text
from opsim.subjects.routes.words import OUT, START

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


def _not_led(tree: Node, vehicle: Node, graph: Graph) -> Iterator[Assumption]:
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
        straight_m, pitch_m = _straight_m(belt, places), quantity(child(belt, "pitch"), "length")
        if child(belt, "length") is None and straight_m is not None and pitch_m is not None and straight_m < pitch_m:
            found = f"from {shown(text(belt, 'from'))} to {shown(text(belt, 'to'))} it is {straight_m:g} m: no room"
            yield problem(
                belt.name_place, ("conveyors", name), f"{found} for a job of {pitch_m:g} m", "add e.g. 'length: 6 m'"
            )


def _straight_m(belt: Node, places: dict[str, Node]) -> float | None:
    """The length of the straight line between the ends; None where it cannot be known."""
    at = [places.get(text(belt, end) or "") for end in ("from", "to")]
    ends = [items(place) or items(place, "at") for place in at]
    said = [[quantity(coordinate, "length") for coordinate in end] for end in ends]
    points = [[length_m for length_m in point if length_m is not None] for point in said]
    if any(not len(point) == len(known) == 2 for point, known in zip(said, points)):
        return None
    return dist(*points)


def carrying_problems(tree: Node) -> Iterator[Problem]:
    """Workers who may have to carry a piece that is heavier than what they carry."""
    legs = _legs(tree)
    for made, product in entries(tree, "products").items():
        carried, mass_kg = child(product, "carried"), quantity(child(product, "mass"), "mass")
        if carried is None or carried.value is not True or mass_kg is None:
            continue
        froms = {before for before, after in _moves(product) if (before, after) not in legs}
        for name, worker in entries(tree, "workers").items():
            limit = child(worker, "most_load")
            most_kg = quantity(limit, "mass")
            station = next((station for station in entries(worker, "skills") if station in froms), None)
            if limit is not None and most_kg is not None and 0 < most_kg < mass_kg and station is not None:
                found = f"{name} may have to carry {shown(made)} ({mass_kg:g} kg) on from {shown(station)}"
                hint = "let a transporter bring it, or somebody stronger work there"
                yield problem(limit.place, ("workers", name, "most_load"), f"{found}, and cannot lift it", hint)


def _moves(product: Node) -> Iterator[Assumption]:
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


def walking_problems(tree: Node) -> Iterator[Problem]:
    """Places that a worker needs and no path leads to, or from: each said once, with the first who needs it."""
    paths = child(tree, "layout", "paths")
    if text(tree, "layout", "distance") != "paths" or paths is None:
        return
    graph = graph_of(paths)
    back = reverse(graph)
    ring_of = {place: ring for ring in rings(graph) for place in ring}
    said: set[tuple[str, str]] = set()
    for name, worker in entries(tree, "workers").items():
        for start, end in _not_led_there(tree, worker, graph, back, ring_of):
            if (start, end) not in said:
                said.add((start, end))
                found = f"no path leads from {shown(start)} to {shown(end)}, and {name} has to walk there"
                yield problem(paths.name_place, ("layout", "paths"), found, _walking_hint(graph, back, start, end))


def _not_led_there(tree: Node, worker: Node, graph: Graph, back: Graph, ring_of: Graph) -> Iterator[Assumption]:
    """(from, to) of what a worker must be able to walk and cannot; ways between all his stations, seen from the first.

    His stations are those of his skills, and those he carries jobs to. He starts at his home, and needs to come back
    there only where idle workers go home. ``ring_of`` : to each place, those with ways to it and back.
    """
    known = entries(tree, "layout", "places")
    skilled = entries(worker, "skills")
    stations = [entries(tree, "stations").get(name) for name in (*skilled, *_carried_to(tree, skilled))]
    places = [place for station in stations if (place := text(station, "at")) in known and place is not None]
    if not places:
        return
    first, home = places[0], text(worker, "home")
    wanted = [place for place in dict.fromkeys([*places, home]) if place is not None and place in known]
    if set(wanted).issubset(ring_of.get(first, ())):  # NOTE: most often; to walk the graph for each worker is square
        return
    there, here = reached(graph, [first]), reached(back, [first])
    goes_home = text(tree, "allocation", "idle") == "home"
    for place in wanted:
        if place not in there and (place in places or goes_home):
            yield first, place
        if place not in here:
            yield place, first


def _carried_to(tree: Node, skilled: Collection[str]) -> Iterator[str]:
    """The stations that jobs are carried to from those where somebody works."""
    for product in entries(tree, "products").values():
        carried = child(product, "carried")
        if carried is None or carried.value is not True:
            continue
        for here, there in pairwise(items(product, "route")):
            if not set(one_of(here)).isdisjoint(skilled):
                yield from one_of(there)
        for here_name, row in entries(product, "routing").items():
            if here_name in skilled:
                yield from (name for name, _ in onward(row) if name != OUT)
        yield from _reworked(tree, product, skilled)


def _reworked(tree: Node, product: Node, skilled: Collection[str]) -> Iterator[str]:
    """Where jobs are carried for rework, and back."""
    for name in stations_of(product):
        rework = rework_at(entries(tree, "stations").get(name))
        if rework is not None and name in skilled:
            yield rework.value
        if rework is not None and rework.value in skilled:
            yield name


def _walking_hint(graph: Graph, back: Graph, *places: str) -> str:
    cut_off = next((place for place in places if not graph.get(place) and not back.get(place)), None)
    return "is a path missing, or 'one_way' too much?" if cut_off is None else f"add e.g. [{cut_off}, ...]"


def graph_of(paths: Node) -> dict[str, set[str]]:
    """Where one step leads from each place."""
    graph: dict[str, set[str]] = {}
    for way in items(paths):
        if isinstance(way.value, dict):
            steps = [(text(way, "from"), text(way, "to"))]
        else:
            steps = list(pairwise(text(place) for place in items(way)))
        one_way = child(way, "one_way")
        for a, b in steps:
            if a is not None and b is not None:
                graph.setdefault(a, set()).add(b)
                if one_way is None or one_way.value is not True:
                    graph.setdefault(b, set()).add(a)
    return graph


FAR = 20
"""Times as far from everything as places usually are from each other."""
FAR_M = 50.0
NEAR_M = 1.0
MOST_PLACES = 300
"""For which each is compared with every other one."""
STRAIGHT = 0.99
"""Of the straight line: what is shorter cannot be walked."""
LONG = 10
Places = Mapping[str, tuple[float, float]]


def distance_risks(scenario: Scenario) -> Iterator[str]:
    """Places far away or in one point, a layout the size of a table, ways of an impossible length."""
    places = scenario.layout.places
    if len(places) <= MOST_PLACES:
        yield from _far(places)
        yield from _one_point(places)
        yield from _tiny(places)
    yield from _lengths(scenario)


def _far(places: Places) -> Iterator[str]:
    nearest = {
        name: min((dist(at, places[o]) for o in places if o != name), default=0.0) for name, at in places.items()
    }
    usual = median(nearest.values()) if nearest else 0.0
    for name in sorted(places, key=natural_key):
        if nearest[name] > max(FAR * usual, FAR_M) and usual > 0:
            yield f"{name} is {nearest[name]:g} m from the nearest other place, others {usual:g} m: is it in metres?"


def _one_point(places: Places) -> Iterator[str]:
    names_at: dict[tuple[float, float], list[str]] = {}
    for name in sorted(places, key=natural_key):
        x, y = places[name]
        names_at.setdefault((x, y), []).append(name)
    for names in names_at.values():
        if len(names) > 1:
            yield f"{enumerated(names)} are in one and the same point: no way between them"


def _tiny(places: Places) -> Iterator[str]:
    widest = max((dist(a, b) for a, b in combinations(places.values(), 2)), default=inf)
    if len(places) > 2 and 0 < widest < NEAR_M:
        yield f"all places lie within {widest:g} m: are they in metres?"


def _lengths(scenario: Scenario) -> Iterator[str]:
    """Lengths that are given, against the straight line between the ends."""
    places = scenario.layout.places
    given = [("the path", way.start, way.end, way.length_m) for way in scenario.layout.path_steps]
    given += [(f"conveyor {name},", belt.start, belt.end, belt.length_m) for name, belt in scenario.conveyors.items()]
    for what, start, end, length_m in given:
        if length_m is None:
            continue
        straight_m = dist(places[start], places[end])
        said = f"{what} from {start} to {end} is {length_m:g} m long, the straight line {straight_m:g} m"
        if length_m < STRAIGHT * straight_m:
            yield f"{said}: nothing is shorter than straight"
        elif length_m > LONG * straight_m > 0:
            yield f"{said}: is it in metres?"


def vehicles(plan: Plan) -> Iterator[Assumption]:
    """Of conveyors and transporters."""
    if plan.transporters:
        names = listed([pool.name for pool in plan.transporters])
        yield "transport", f"{names}: drivers and batteries always there; vehicles do not meet on the road"
        yield "transport", f"{names}: called when a job's next place is sure, oldest call first; never waits to fill"
    if plan.conveyors:
        names = listed([plan.stations[belt.station].name for belt in plan.conveyors])
        yield "transport", f"{names}: belts run all the time, and never break"


def by_themselves(plan: Plan) -> bool:
    """Whether some jobs pass from a station to another without anybody or anything that brings them."""
    brought = {(leg.before, leg.after) for pool in plan.transporters for leg in pool.legs}
    brought |= {pair for line in plan.lines for pair in pairwise(line.stations)}
    belts = {belt.station for belt in plan.conveyors}
    for product in plan.products:
        if not product.carried:
            for step, onward in zip(product.route, product.onward):
                ahead = {rank for _, to in onward if to >= 0 for rank in product.route[to].stations}
                pairs = {(here, there) for here in step.stations for there in ahead}
                if not pairs <= brought | {pair for pair in pairs if belts.intersection(pair)}:
                    return True
    return not any(len(product.route) > 1 for product in plan.products)
