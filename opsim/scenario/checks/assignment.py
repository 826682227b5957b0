"""Zones, priorities and stops of a round: what is named is there, and means something."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.references import named
from opsim.scenario.positions import Node, child, entries, items, problem, text


def assignment_problems(tree: Node) -> Iterator[Problem]:
    """Zones of stations that are not there or need a skill, priorities that nothing reads, stops without a round."""
    for name, worker in entries(tree, "workers").items():
        yield from _zone(tree, name, worker)
    yield from _priorities(tree)
    serve = child(tree, "allocation", "serve")
    if serve is not None and serve.value == "one" and text(tree, "allocation", "idle") != "patrol":
        found = "'serve: one' is for who goes round, and idle workers do not patrol"
        yield problem(serve.name_place, ("allocation", "serve"), found, "add 'idle: patrol', or remove it")


def _zone(tree: Node, name: str, worker: Node) -> Iterator[Problem]:
    stations = entries(tree, "stations")
    for number, station in enumerate(items(worker, "zone")):
        path = ("workers", name, "zone", number)
        yield from named(station, stations, "station", path)
        known = isinstance(station.value, str) and station.value in stations
        if known and station.value not in entries(worker, "skills"):
            found = f"{shown(station.value)} is in the zone of {name}, who has no skill there"
            yield problem(station.place, path, found, f"add '{station.value}: 1.0' to the skills of {name}")


def _priorities(tree: Node) -> Iterator[Problem]:
    """Stations with a priority that the allocation does not look at."""
    said = child(tree, "allocation", "priorities")
    if said is None or not isinstance(said.value, list) or any(one.value != "products" for one in items(said)):
        return
    for name, station in entries(tree, "stations").items():
        priority = child(station, "priority")
        if priority is not None and priority.value != 0:
            found = f"{name} has a priority, and allocation.priorities does not name stations"
            yield problem(priority.name_place, ("stations", name, "priority"), found, "add stations to that list")
