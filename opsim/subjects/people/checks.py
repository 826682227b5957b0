"""Work that no worker can do would wait for ever: somebody has the skill, and a team is large enough.

Zones, priorities and stops of a round: what is named is there, and means something.

Job rotations: members and stations that exist, members who can do something there, posts that somebody can man.

Workers who are to move as a recorded person: somebody of that name was recorded.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.engine.rules import ROTATION_RULES
from opsim.libraries import LibraryMissing, library_people, resolve_library
from opsim.problems import Problem, did_you_mean, natural_key, shown
from opsim.scenario.checks.lookup import emulators, named, visited
from opsim.scenario.tree import Node, TreePath, child, entries, items, problem, text
from opsim.subjects.sequencing.checks import rule_problems, setup_times


def recorded_people(tree: Node, folder: Path) -> list[str] | None:
    """In natural order, whoever was recorded for an emulated task of the scenario.

    None where a library cannot be read: then nothing can be said of its people, and that is a problem of its own.
    """
    files = {name: text(node) for name, node in entries(tree, "libraries").items()}
    found: set[str] = set()
    for path, model in emulators(tree):
        library, _, inside = model.value.partition("/")
        if not inside or path[0] != "tasks":
            continue
        file = files.get(library)
        if file is None:
            return None
        try:
            found.update(library_people(resolve_library(file, folder)).get(inside, ()))
        except LibraryMissing:
            return None
    return sorted(found, key=natural_key)


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


def rotation_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with the rotations of a scenario."""
    seen: dict[str, str] = {}
    for name, rotation in entries(tree, "rotations").items():
        path = ("rotations", name)
        yield from _members(tree, rotation, path, seen)
        yield from _posts(tree, rotation, path)
        yield from rule_problems(child(rotation, "rule"), (*path, "rule"), "opsim.rotation", ROTATION_RULES)


def _members(tree: Node, rotation: Node, path: TreePath, seen: dict[str, str]) -> Iterator[Problem]:
    """Members who are no workers, who are named twice, or who have no skill for any post."""
    workers, stations = entries(tree, "workers"), _stations(rotation)
    for number, node in enumerate(items(rotation, "workers")):
        here = (*path, "workers", number)
        yield from named(node, workers, "worker", here)
        if not isinstance(node.value, str) or node.value not in workers:
            continue
        before = seen.setdefault(node.value, str(path[-1]))
        if before != path[-1] or any(other.value == node.value for other in items(rotation, "workers")[:number]):
            where = "twice here" if before == path[-1] else f"in rotation {before} already"
            yield problem(node.place, here, f"{node.value} is {where}", "a worker has one place in one rotation")
        skills = entries(workers[node.value], "skills")
        if stations and not stations.intersection(skills):
            hint = f"add e.g. '{min(stations)}: 1.0' to the skills of {node.value}"
            yield problem(node.place, here, f"{node.value} has no skill at any of the posts", hint)


def _posts(tree: Node, rotation: Node, path: TreePath) -> Iterator[Problem]:
    """Stations that do not exist, and posts that none of the members can man."""
    stations, workers = entries(tree, "stations"), entries(tree, "workers")
    members = [node.value for node in items(rotation, "workers") if isinstance(node.value, str)]
    known = all(member in workers for member in members)
    skills = {skill for member in members if member in workers for skill in entries(workers[member], "skills")}
    for number, post in enumerate(items(rotation, "posts")):
        inside = items(post) or [post]
        for node in inside:
            yield from named(node, stations, "station", (*path, "posts", number))
        names = [node.value for node in inside if isinstance(node.value, str)]
        if known and names and not skills.intersection(names) and all(name in stations for name in names):
            found = f"none of the members has a skill at {' or '.join(map(shown, names))}"
            yield problem(post.place, (*path, "posts", number), found, "give one of them the skill, or leave it out")


def _stations(rotation: Node) -> set[str]:
    """The stations of all posts that are named."""
    nodes = [node for post in items(rotation, "posts") for node in (items(post) or [post])]
    return {node.value for node in nodes if isinstance(node.value, str)}


def person_problems(tree: Node, folder: Path) -> Iterator[Problem]:
    """Persons whom no emulated task of the scenario was learned from."""
    asked = {name: child(worker, "person") for name, worker in entries(tree, "workers").items()}
    nodes = {name: node for name, node in asked.items() if node is not None and isinstance(node.value, str)}
    people = recorded_people(tree, folder) if nodes else None
    for name, node in nodes.items():
        if people is not None and node.value not in people:
            hint = did_you_mean(node.value, people, otherwise="recorded") or "no task of this scenario is emulated"
            found = f"no person {shown(node.value)} was recorded for the tasks of this scenario"
            yield problem(node.place, ("workers", name, "person"), found, hint)


def team_problems(tree: Node) -> Iterator[Problem]:
    """Tasks for more workers than have the skill, and teams of people who serve only where they stand."""
    patrols, on_a_way = text(tree, "allocation", "idle") == "patrol", visited(tree)
    for name, station in entries(tree, "stations").items():
        team = _team_of(tree, station) if name in on_a_way else None
        if team is None:
            continue
        task, wanted = team
        able = [worker for worker, node in entries(tree, "workers").items() if name in entries(node, "skills")]
        if 0 < len(able) < wanted:  # nobody at all is told of elsewhere
            found = (
                f"task {shown(task)} takes a team of {wanted}, and only {len(able)} of the workers can work at {name}"
            )
            yield problem(
                station.name_place, ("stations", name), found, "give more workers the skill, or a smaller team"
            )
        if patrols:
            found = (
                f"task {shown(task)} takes a team, and workers who patrol serve each only the station where he stands"
            )
            yield problem(station.name_place, ("stations", name), found, "write 'idle: stay' or 'idle: home'")


def _team_of(tree: Node, station: Node) -> tuple[str, int] | None:
    """The task of a station for most workers, and how many; None where one is enough everywhere."""
    teams = []
    for node in items(station, "tasks"):
        size = child(tree, "tasks", node.value, "team") if isinstance(node.value, str) else None
        if size is not None and type(size.value) is int and size.value > 1:
            teams.append((node.value, size.value))
    return max(teams, key=lambda team: team[1], default=None)
