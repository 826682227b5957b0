"""The ways of products over paced lines: on at the first station, from each to the next, off at the last."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import one_of, onward
from opsim.scenario.positions import Node, child, entries, items, problem
from opsim.scenario.schema.routing import OUT, START

Step = tuple[str, str, Node]
"""(from, to, where it is said); START and OUT stand for the way in and the way out."""


def line_way_problems(tree: Node) -> Iterator[Problem]:
    """Ways that leave a line, or come onto it, in the middle; and what would move a job otherwise than the line."""
    lines = {name: [one.value for one in items(line, "stations")] for name, line in entries(tree, "lines").items()}
    for name, stations in lines.items():
        known = all(isinstance(one, str) and one in entries(tree, "stations") for one in stations)
        if not stations or not known or len(set(stations)) < len(stations):
            continue
        for product, node in entries(tree, "products").items():
            steps = [step for step in _steps(node) if set(stations) & {step[0], step[1]}]
            yield from _way(name, stations, product, steps)
            yield from _alternatives(name, stations, product, node)
            yield from _moved(stations, name, product, node, bool(steps))
        yield from _legs(tree, name, stations)
        yield from _cards(tree, name, stations)
        yield from _rework(tree, name, stations)
        yield from _kept(tree, name, stations)


def _way(line: str, stations: list[str], product: str, steps: list[Step]) -> Iterator[Problem]:
    """The first step of a product that a line does not go."""
    allowed = set(pairwise(stations))
    for before, after, node in steps:
        if (before, after) in allowed or (before not in stations and after == stations[0]):
            continue
        if before == stations[-1] and after not in stations[1:]:
            continue
        came = f"begins at {after}" if before == START else f"comes from {before} to {after}"
        found = f"{product} {came}" if after != OUT else f"{product} leaves from {before}"
        yield problem(
            node.place,
            ("products", product),
            f"{found}, and the line {line} goes {', '.join(stations)}",
            "a way goes over all its stations in this order; one without work there has no tasks",
        )
        return


def _alternatives(line: str, stations: list[str], product: str, node: Node) -> Iterator[Problem]:
    for number, step in enumerate(items(node, "route")):
        if len(one_of(step)) > 1 and set(one_of(step)) & set(stations):
            found = f"{product} goes to {' or '.join(one_of(step))}, and the line {line} leads to one of them alone"
            yield problem(step.place, ("products", product, "route", number), found, "name one station")


def _steps(product: Node) -> Iterator[Step]:
    """From where to where a product may go."""
    route = items(product, "route")
    ends = [] if not route else [Node(OUT, route[-1].place)]
    for here, there in pairwise([Node(START, product.place), *route, *ends]):
        yield from ((before, after, there) for before in one_of(here) for after in one_of(there))
    for name, row in entries(product, "routing").items():
        for other, node in onward(row):
            yield name, other, node


def _moved(stations: list[str], line: str, product: str, node: Node, passes: bool) -> Iterator[Problem]:
    carried = child(node, "carried")
    if passes and carried is not None and carried.value is True:
        found = f"{product} goes over the line {line}, which moves it"
        yield problem(carried.place, ("products", product, "carried"), found, "remove 'carried'")
    for station, pieces in entries(node, "split").items():
        if station in stations:
            found = f"{product} is split at {station}, on the line {line}"
            yield problem(pieces.name_place, ("products", product, "split"), found, "split it after the line")


def _legs(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    for name, vehicle in entries(tree, "transporters").items():
        for number, leg in enumerate(items(vehicle, "legs")):
            ends = [end.value for end in items(leg)]
            if len(ends) == 2 and (ends[1] in stations or ends[0] in stations):
                found = f"{name} would bring jobs to or from a station of the line {line}, which comes when it comes"
                hint = "put a store or a station between them"
                yield problem(leg.place, ("transporters", name, "legs", number), found, hint)


def _cards(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    for name, card in entries(tree, "cards").items():
        begin = child(card, "from")
        for node in [] if begin is None else items(begin) or [begin]:
            if node.value in stations[1:]:
                found = f"a card is taken before {node.value}, and the line {line} waits for nobody there"
                yield problem(node.place, ("cards", name, "from"), found, f"take it before {stations[0]}")


def _rework(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    for name, station in entries(tree, "stations").items():
        rework = child(station, "inspect", "then", "rework")
        if rework is not None and rework.value in stations and name not in stations:
            found = f"a job cannot come back to {shown(rework.value)}, on the line {line}"
            hint = "rework it at a station of its own"
            yield problem(rework.place, ("stations", name, "inspect", "then"), found, hint)


def _kept(tree: Node, line: str, stations: list[str]) -> Iterator[Problem]:
    """Stations from which jobs come onto the line, and that ask for a place there before they begin."""
    before = {
        step[0] for product in entries(tree, "products").values() for step in _steps(product) if step[1] == stations[0]
    }
    for name in sorted(before - set(stations)):
        blocking = child(tree, "stations", name, "blocking")
        if blocking is not None and blocking.value == "before":
            found = f"no place on the line {line} can be kept: a job comes onto it when it moves"
            yield problem(blocking.place, ("stations", name, "blocking"), found, "write 'blocking: after'")
