"""A name that an override adds and nothing uses is most likely a slip of the pen."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from opsim.problems import Problem, nearest, shown
from opsim.scenario.checks.sequence import setup_times
from opsim.scenario.checks.ways import visited
from opsim.scenario.positions import Node, entries, items, problem, text


def addition_problems(tree: Node, base: Node) -> Iterator[Problem]:
    """Places, tasks and stations that are not in the base, are used by nobody, and read like one that is there."""
    stations, workers = entries(tree, "stations").values(), entries(tree, "workers").values()
    places = {text(station, "at") for station in stations} | {text(worker, "home") for worker in workers}
    tasks = {task.value for station in stations for task in items(station, "tasks") if isinstance(task.value, str)}
    tasks |= {time.value for station in stations for time in setup_times(station) if isinstance(time.value, str)}
    yield from _unused(tree, base, ("layout", "places"), places, "place")
    yield from _unused(tree, base, ("tasks",), tasks, "task")
    yield from _unused(tree, base, ("stations",), visited(tree), "station")


def _unused(tree: Node, base: Node, path: tuple[str, ...], used: Collection, what: str) -> Iterator[Problem]:
    known = entries(base, *path)
    for name, node in entries(tree, *path).items():
        near = nearest(name, known) if name not in known and name not in used else None
        if near is not None:
            found = f"this adds a {what} {shown(name)} that nothing uses"
            yield problem(node.name_place, (*path, name), found, f"did you mean {shown(near)}?")
