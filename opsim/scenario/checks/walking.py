"""With a network of paths, a worker must be able to walk wherever the work is."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import pairwise

from opsim.graph import Graph, reached, reverse, rings
from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import one_of, onward, rework_at, stations_of
from opsim.scenario.positions import Node, child, entries, items, problem, text
from opsim.scenario.schema.routing import OUT


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
        for start, end in _not_led(tree, worker, graph, back, ring_of):
            if (start, end) not in said:
                said.add((start, end))
                found = f"no path leads from {shown(start)} to {shown(end)}, and {name} has to walk there"
                yield problem(paths.name_place, ("layout", "paths"), found, _hint(graph, back, start, end))


def _not_led(tree: Node, worker: Node, graph: Graph, back: Graph, ring_of: Graph) -> Iterator[tuple[str, str]]:
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


def _hint(graph: Graph, back: Graph, *places: str) -> str:
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
