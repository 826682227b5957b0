"""With a network of paths, a worker must be able to walk wherever the work is."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from opsim.graph import Graph, reached, reverse
from opsim.problems import Problem, shown
from opsim.scenario.positions import Node, child, entries, items, problem, text


def walking_problems(tree: Node) -> Iterator[Problem]:
    """Places that a worker needs and no path leads to, or from: each said once, with the first who needs it."""
    paths = child(tree, "layout", "paths")
    if text(tree, "layout", "distance") != "paths" or paths is None:
        return
    graph = _graph(paths)
    back = reverse(graph)
    said: set[str] = set()
    for name, worker in entries(tree, "workers").items():
        places = [place for place in _places(tree, worker) if place in entries(tree, "layout", "places")]
        if len(places) < 2:
            continue
        there, home = reached(graph, places[:1]), reached(back, places[:1])
        for place in dict.fromkeys(places[1:]):
            if place in said or (place in there and place in home):
                continue
            said.add(place)
            start, end = (places[0], place) if place not in there else (place, places[0])
            found = f"no path leads from {shown(start)} to {shown(end)}, and {name} has to walk there"
            node = entries(tree, "layout", "places")[place]
            yield problem(node.name_place, ("layout", "places", place), found, _hint(graph, back, place))


def _hint(graph: Graph, back: Graph, place: str) -> str:
    if not graph.get(place) and not back.get(place):
        return f"add e.g. [{place}, ...] to the paths"
    return "is a path missing, or 'one_way' too much?"


def _graph(paths: Node) -> dict[str, set[str]]:
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


def _places(tree: Node, worker: Node) -> list[str]:
    """Where the worker works and starts, the work first."""
    stations = [entries(tree, "stations").get(name) for name in entries(worker, "skills")]
    places = [text(station, "at") for station in stations] + [text(worker, "home")]
    return [place for place in places if place is not None]
