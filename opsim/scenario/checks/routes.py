"""A routing by probability must begin, go on from each station, and end.

With a network of paths, a worker must be able to walk wherever the work is.

Rework: it goes to a station that is there, and not to one that is still to come.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from itertools import pairwise

from opsim.layout import Graph, reached, reverse, rings
from opsim.problems import Problem, shown
from opsim.scenario.checks.lookup import named, one_of, onward, points, rework_at, stations_of
from opsim.scenario.schema.routing import OUT, START
from opsim.scenario.tree import Node, Part, child, entries, items, problem, text


def routing_problems(tree: Node) -> Iterator[Problem]:
    """Routings without a start, with a dead end, with a way nobody comes by, or that never end."""
    for name, product in entries(tree, "products").items():
        routing = child(product, "routing")
        if routing is not None and isinstance(routing.value, dict):
            yield from _words_kept(tree, routing, ("products", name, "routing"))
            yield from _structure(routing, points(tree), entries(tree, "stores"), ("products", name, "routing"))


def _words_kept(tree: Node, routing: Node, path: tuple[str, ...]) -> Iterator[Problem]:
    for word in (START, OUT):
        station = points(tree).get(word)
        if station is not None:
            found = f"no station can be called {word!r} where a product has a routing"
            yield problem(station.name_place, ("stations", word), found, f"{word!r} has a meaning there")
    if OUT in entries(routing):
        place = entries(routing)[OUT].name_place
        yield problem(place, (*path, OUT), f"a job that is {OUT!r} is done; nothing comes after", "remove the line")


def _structure(
    routing: Node, stations: dict[str, Node], stores: Collection[str], path: tuple[str, ...]
) -> Iterator[Problem]:
    rows = {name: row for name, row in entries(routing).items() if name != OUT and name not in stores}
    if START not in rows:
        first = next(iter(rows), "cut")
        yield problem(routing.name_place, path, "nothing says where a job begins", f"add e.g. 'start: {first}'")
        return
    yield from _targets(rows, set(stations).difference(stores), path)
    graph = {name: [other for other, _ in onward(row)] for name, row in rows.items()}
    possible = {name: [other for other, _ in onward(row) if _taken(row, other)] for name, row in rows.items()}
    for name, station in stations.items():
        rework = rework_at(station)
        if rework is not None and name in graph and rework.value in rows:
            graph[name].append(rework.value)
    there, home = reached(graph, [START]), reached(reverse(possible), [OUT, *stores])
    ends = {OUT, *rows, *stores}
    dead_end = any(other not in ends for others in graph.values() for other in others)
    for name, row in rows.items():
        if name not in there:
            yield problem(row.name_place, (*path, name), f"no way leads to {shown(name)}", "is it missing elsewhere?")
        elif name not in home and not dead_end and name != START:
            found = f"from {shown(name)} no job ever gets out"
            yield problem(row.name_place, (*path, name), found, "some way must lead to 'out'")


def _targets(rows: dict[str, Node], stations: Collection[str], path: tuple[str, ...]) -> Iterator[Problem]:
    """Stations that jobs are sent to, and that nothing leads on from, each said once."""
    said = {OUT, *rows}
    for name, row in rows.items():
        for other, node in onward(row):
            if other == START:
                hint = "write the station's name"
                yield problem(node.place, (*path, name), "'start' is where jobs begin; no way leads back to it", hint)
            elif other in stations and other not in said:
                said.add(other)
                found = f"nothing says where a job goes after {shown(other)}"
                yield problem(node.place, (*path, name), found, f"add e.g. '{other}: out'")


def _taken(row: Node, other: str) -> bool:
    """Whether a way has a probability above 0, as far as one can see."""
    probability = entries(row).get(other)
    return probability is None or probability.value not in (0, 0.0)


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


def _not_led_there(tree: Node, worker: Node, graph: Graph, back: Graph, ring_of: Graph) -> Iterator[tuple[str, str]]:
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
