"""Work that no worker can do would wait for ever."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.sequence import setup_times
from opsim.scenario.checks.ways import visited
from opsim.scenario.positions import Node, child, entries, items, problem, text


def staffing_problems(tree: Node) -> Iterator[Problem]:
    """Stations on a route with a task for a worker, and no worker with the skill."""
    skilled = {station for worker in entries(tree, "workers").values() for station in entries(worker, "skills")}
    patrols = text(tree, "allocation", "idle") == "patrol"
    stops = [stop.value for worker in entries(tree, "workers").values() for stop in items(worker, "patrol")]
    rounds = {stop for stop in stops if isinstance(stop, str)}
    on_a_route = visited(tree)
    for name, station in entries(tree, "stations").items():
        manual = _manual(tree, station)
        if manual is not None and name in on_a_route and name not in skilled:
            found = f"{manual} needs a worker, and no worker has the skill {shown(name)}"
            workers = entries(tree, "workers")
            first = next(iter(workers), None)
            hint = (
                f"add '{name}: 1.0' to the skills of {first} or another worker" if first else "add a section 'workers:'"
            )
            yield problem(station.name_place, ("stations", name), found, hint)
        elif manual is not None and name in on_a_route and (crew := _all_in_crews(tree, name)) is not None:
            found = (
                f"{manual} needs a worker, and all with the skill {shown(name)} work for crew {crew} or another alone"
            )
            yield problem(station.name_place, ("stations", name), found, f"add {name} to the crew, or somebody for it")
        elif manual is not None and name in on_a_route and patrols and rounds and name not in rounds:
            found = f"{manual} needs a worker, and nobody goes round by {shown(name)}"
            yield problem(station.name_place, ("stations", name), found, f"add {name} to the patrol of a worker")


def _all_in_crews(tree: Node, station: str) -> str | None:
    """The crew of the first of those with a skill, where the station is in no crew and all of them are in one."""
    crews = {name: [node.value for node in items(crew, "workers")] for name, crew in entries(tree, "crews").items()}
    if any(node.value == station for crew in entries(tree, "crews").values() for node in items(crew, "stations")):
        return None
    able = [name for name, worker in entries(tree, "workers").items() if station in entries(worker, "skills")]
    theirs = [next((crew for crew, members in crews.items() if name in members), None) for name in able]
    return theirs[0] if theirs and None not in theirs else None


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
    first: dict[tuple[str, int, int], str] = {}
    workers = entries(tree, "workers")
    for name, worker in workers.items():
        source, line, column = worker.name_place
        first.setdefault((source.file, line, column), name)
    return {name: workers[name] for name in first.values()}


def _manual(tree: Node, station: Node) -> str | None:
    """The first work at a station that is not automatic, in words: a task, or its set-up; or None."""
    for task in items(station, "tasks"):
        if isinstance(task.value, str) and _by_hand(tree, task.value):
            return f"task {shown(task.value)}"
    attended = child(station, "setup", "attended")
    if attended is not None and attended.value is False:
        return None
    by_hand = any(
        isinstance(time.value, str) and (time.value not in entries(tree, "tasks") or _by_hand(tree, time.value))
        for time in setup_times(station)
    )
    return "the set-up" if by_hand else None


def _by_hand(tree: Node, task: str) -> bool:
    node = entries(tree, "tasks").get(task)
    automatic = child(node, "automatic")
    return node is not None and (automatic is None or automatic.value is not True)
