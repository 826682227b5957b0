"""A routing by probability must begin, go on from each station, and end."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from opsim.layout import reached, reverse
from opsim.problems import Problem, shown
from opsim.scenario.checks.lookup import onward, points, rework_at
from opsim.scenario.tree import Node, child, entries, problem
from opsim.subjects.routes.words import OUT, START


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
