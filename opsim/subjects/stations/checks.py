"""Batches: as many jobs as they take can wait for each other, and no worker would have to carry them on.

What is risky: batches that never fill. What the assumption sheet says of blocking, buffers and batches.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

from opsim.plan import Plan
from opsim.problems import Assumption, Problem, listed, natural_key, shown
from opsim.scenario.checks.lookup import stations_of, whole_number
from opsim.scenario.schema import Scenario, Station
from opsim.scenario.tree import Node, Part, child, entries, problem
from opsim.scenario.warnings.routes import between, first_of, last_of, points_of, way_of, ways
from opsim.subjects.stations.plan import STORE


def batch_problems(tree: Node) -> Iterator[Problem]:
    """Buffers in which a batch never fills; jobs of a batch that one worker would have to carry."""
    for name, station in entries(tree, "stations").items():
        batch, buffer = child(station, "batch"), child(station, "buffer")
        if batch is None:
            continue
        size, places = whole_number(child(batch, "size")), whole_number(buffer)
        if size is not None and places is not None and places < size:
            found = f"a batch of {size} never comes together in a buffer of {places}"
            hint = f"give the buffer at least {size} places"
            yield problem(batch.name_place, ("stations", name, "batch"), found, hint)
        yield from _carried(tree, name)


def _carried(tree: Node, name: str) -> Iterator[Problem]:
    for product, node in entries(tree, "products").items():
        carried = child(node, "carried")
        if carried is not None and carried.value is True and name in stations_of(node):
            found = f"{shown(product)} comes to {shown(name)}, whose batches nobody can carry on"
            hint = "remove 'carried', or give the station no batch"
            yield problem(carried.place, ("products", product, "carried"), found, hint)


def batch_before_problems(tree: Node, station: Node, path: tuple[Part, ...]) -> Iterator[Problem]:
    """A batch would begin when its first job has a place downstream; the others would wait after all."""
    batch, own, of_all = child(station, "batch"), child(station, "blocking"), child(tree, "flow", "blocking")
    blocking = of_all if own is None else own
    if batch is not None and blocking is not None and blocking.value == "before":
        found = "the jobs of a batch go on one by one, and cannot all be sure of a place before it begins"
        yield problem(batch.name_place, (*path, "batch"), found, "write 'blocking: after' at this station")


def batch_risks(scenario: Scenario) -> Iterator[str]:
    """Stations where jobs of each kind may all be one short of a batch, or that those on a server come back to."""
    yield from _back_at_once(scenario)
    for name in sorted(scenario.stations, key=natural_key):
        station = scenario.stations[name]
        if station.batch is None or station.batch.most_wait_s is not None:
            continue
        most = _kinds(name, station, scenario) * (station.batch.size - 1)
        remedy = "give the batch a 'most_wait'"
        if station.buffer is not None and station.buffer <= most and most >= station.batch.size:
            yield (
                f"{name} may fill up with jobs of different kinds, up to {most} of them, none of which is a batch of "
                f"{station.batch.size}: then nothing moves any more; {remedy}, or more room"
            )
        for card in sorted(scenario.cards, key=natural_key):
            if scenario.cards[card].n <= most and _inside(name, card, scenario):
                yield (
                    f"{scenario.cards[card].n} cards of {card} may all wait at {name} for a batch of "
                    f"{station.batch.size} that never fills; {remedy}, or more cards"
                )


def _back_at_once(scenario: Scenario) -> Iterator[str]:
    """Who shares a server cannot keep its place for the next visit: it needs one in the buffer."""
    onward = ways(scenario)
    for name in sorted(scenario.stations, key=natural_key):
        station = scenario.stations[name]
        shared = station.batch is not None or any(name in made.split for made in scenario.products.values())
        if shared and station.buffer is not None and name in onward.get(name, ()):
            yield (
                f"jobs that share a server of {name} come back to it at once: when its buffer is full, nothing moves "
                "any more; give it 'buffer: unlimited'"
            )


def _kinds(name: str, station: Station, scenario: Scenario) -> int:
    """How many kinds of jobs come by that do not go together in a batch."""
    assert station.batch is not None
    passing = {product for product, made in scenario.products.items() if name in points_of(made)}
    if station.batch.of == "family":
        return len({scenario.products[product].family or product for product in passing})
    return len(passing) if station.batch.of == "product" else 1


def _inside(name: str, card: str, scenario: Scenario) -> bool:
    """Whether every job that comes to a station holds a card of a loop."""
    loop = scenario.cards[card]
    passing = [product for product, made in scenario.products.items() if name in points_of(made)]
    for product in passing:
        made = scenario.products[product]
        if loop.products is not None and product not in loop.products:
            return False
        if name not in between(way_of(made, scenario), loop.begin or first_of(made), loop.end or last_of(made)):
            return False
    return bool(passing)


def assumed_buffers(plan: Plan) -> Iterator[Assumption]:
    first = [place.name for place in plan.stations if place.place_first]
    if first:
        yield "blocking", f"{listed(first)}: a job is begun only when its place downstream is kept for it"
    stores = [place.name for place in plan.stations if place.kind == STORE and place.buffer == inf]
    if stores:
        yield "buffers", f"unlimited in {listed(stores)}"


def assumed_batches(plan: Plan) -> Iterator[Assumption]:
    for batch in plan.batches:
        name = plan.stations[batch.station].name
        wait = (
            "and waits until it is full" if batch.most_wait_s == inf else f"and waits at most {batch.most_wait_s:g} s"
        )
        yield "batches", f"{name}: {batch.size} jobs at once, {wait}; the time is that of one, however many there are"
