"""Work that no worker can do would wait for ever."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import visited
from opsim.scenario.positions import Node, Place, child, entries, items, problem, text


def staffing_problems(tree: Node) -> Iterator[Problem]:
    """Stations on a route with a task for a worker, and no worker with the skill."""
    skilled = {station for worker in entries(tree, "workers").values() for station in entries(worker, "skills")}
    patrols = text(tree, "allocation", "idle") == "patrol"
    stops = [stop.value for worker in entries(tree, "workers").values() for stop in items(worker, "patrol")]
    rounds = {stop for stop in stops if isinstance(stop, str)}
    on_a_route = visited(tree)
    for name, station in entries(tree, "stations").items():
        manual = _manual_task(tree, station)
        if manual is not None and name in on_a_route and name not in skilled:
            found = f"task {shown(manual)} needs a worker, and no worker has the skill {shown(name)}"
            workers = entries(tree, "workers")
            first = next(iter(workers), None)
            hint = (
                f"add '{name}: 1.0' to the skills of {first} or another worker" if first else "add a section 'workers:'"
            )
            yield problem(station.name_place, ("stations", name), found, hint)
        elif manual is not None and name in on_a_route and patrols and rounds and name not in rounds:
            found = f"task {shown(manual)} needs a worker, and nobody goes round by {shown(name)}"
            yield problem(station.name_place, ("stations", name), found, f"add {name} to the patrol of a worker")


def patrol_problems(tree: Node) -> Iterator[Problem]:
    """Who is to patrol needs a round, and the skills for it; of workers who share a block, the first is named."""
    idle = text(tree, "allocation", "idle")
    for name, worker in _blocks(tree).items():
        patrol = child(worker, "patrol")
        if idle == "patrol" and patrol is None:
            stations = list(entries(worker, "skills")) or ["pack"]
            found = f"idle workers patrol, and nothing says which stations {name} goes round"
            yield problem(
                worker.name_place, ("workers", name), found, f"add e.g. 'patrol: [{', '.join(stations[:3])}]'"
            )
        for number, station in enumerate(items(patrol)):
            known = isinstance(station.value, str) and station.value in entries(tree, "stations")
            if known and station.value not in entries(worker, "skills"):
                found = f"{name} goes round by {shown(station.value)} and has no skill there"
                hint = f"add '{station.value}: 1.0' to the skills of {name}"
                yield problem(station.place, ("workers", name, "patrol", number), found, hint)


def _blocks(tree: Node) -> dict[str, Node]:
    """Workers, but one of those that a workforce makes, which all stand at one place."""
    first: dict[Place, str] = {}
    workers = entries(tree, "workers")
    for name, worker in workers.items():
        first.setdefault(worker.name_place, name)
    return {name: workers[name] for name in first.values()}


def _manual_task(tree: Node, station: Node) -> str | None:
    """The first task of a station that is not automatic, or None."""
    for task in items(station, "tasks"):
        node = entries(tree, "tasks").get(task.value) if isinstance(task.value, str) else None
        automatic = child(node, "automatic")
        if node is not None and (automatic is None or automatic.value is not True):
            return task.value
    return None
