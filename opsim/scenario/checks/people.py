"""The people that the libraries of a scenario were learned from, as far as its tasks are emulated.

Work that no worker can do would wait for ever.

Zones, priorities and stops of a round: what is named is there, and means something.

Crews: members and stations that exist, each in one crew, with nothing at the stations that a crew cannot do.

Job rotations: members and stations that exist, members who can do something there, posts that somebody can man.

Workers who are to move as a recorded person: somebody of that name was recorded.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.engine.rules import ROTATION_RULES
from opsim.libraries import LibraryMissing, library_people, resolve_library
from opsim.problems import Problem, did_you_mean, natural_key, shown
from opsim.scenario.checks.lookup import emulators, named, one_of, onward, rework_at, visited
from opsim.scenario.checks.sequence import rule_problems, setup_times
from opsim.scenario.tree import Node, TreePath, child, entries, items, problem, text


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


_NOT_HERE = {
    "batch": "whose jobs are worked on together, and each job of a crew is in one pair of hands",
    "preempt": "where jobs overtake each other, and those of a crew never do",
    "share": "whose tasks others may do, and nobody but its members works at the stations of a crew",
}


def crew_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with the crews of a scenario."""
    seen: dict[tuple[str, str], str] = {}
    for name, crew in entries(tree, "crews").items():
        path = ("crews", name)
        for key, what in (("stations", "station"), ("workers", "worker")):
            yield from _named_once(tree, crew, key, what, path, seen)
        yield from _skills(tree, crew, path)
        yield from _elsewhere(tree, crew, path)
        yield from _at_stations(tree, crew, path)
        yield from _ways(tree, crew, name)
    yield from _patrols(tree)


def _named_once(tree: Node, crew: Node, key: str, what: str, path: TreePath, seen: dict) -> Iterator[Problem]:
    """Names that lead nowhere, and what has a place in a crew already."""
    name = str(path[-1])
    for number, node in enumerate(items(crew, key)):
        here = (*path, key, number)
        yield from named(node, entries(tree, f"{what}s"), what, here)
        if not isinstance(node.value, str):
            continue
        before = seen.setdefault((what, node.value), name)
        if before != name or node.value in _crew_names(crew, key)[:number]:
            where = "twice here" if before == name else f"in crew {before} already"
            yield problem(node.place, here, f"{node.value} is {where}", f"a {what} has one place in one crew")


def _skills(tree: Node, crew: Node, path: TreePath) -> Iterator[Problem]:
    """Members who cannot go with a job to every station."""
    workers, stations = entries(tree, "workers"), entries(tree, "stations")
    for number, node in enumerate(items(crew, "workers")):
        if not isinstance(node.value, str) or node.value not in workers:
            continue
        skills = entries(workers[node.value], "skills")
        lacking = [
            station for station in _crew_names(crew, "stations") if station in stations and station not in skills
        ]
        if lacking:
            found = f"{node.value} has no skill at {shown(lacking[0])}, where his job may take him"
            hint = f"add '{lacking[0]}: 1.0' to the skills of {node.value}"
            yield problem(node.place, (*path, "workers", number), found, hint)


def _elsewhere(tree: Node, crew: Node, path: TreePath) -> Iterator[Problem]:
    """Members who change posts, or come when a paced line calls; stations that are part of a paced line."""
    for section, key, mine, found in (
        ("rotations", "workers", "workers", "{} changes posts in rotation {}, and a crew keeps its members"),
        ("lines", "andon.workers", "workers", "{} is called to line {}, and a member works for his crew alone"),
        ("lines", "stations", "stations", "{} is part of the paced line {}, which moves by itself"),
    ):
        for other, block in entries(tree, section).items():
            there = [node.value for node in items(block, *key.split("."))]
            for number, node in enumerate(items(crew, mine)):
                if isinstance(node.value, str) and node.value in there:
                    yield problem(node.place, (*path, mine, number), found.format(node.value, other), "remove one")


def _at_stations(tree: Node, crew: Node, path: TreePath) -> Iterator[Problem]:
    """What the stations of a crew cannot have: batches, pre-emption, splits, tasks of teams."""
    stations = entries(tree, "stations")
    partners = {text(station, "share", "with") for station in stations.values()}
    splits = {at for product in entries(tree, "products").values() for at in entries(product, "split")}
    for number, node in enumerate(items(crew, "stations")):
        station = stations.get(node.value) if isinstance(node.value, str) else None
        if station is None:
            continue
        reasons = [f"{key!r}, {why}" for key, why in _NOT_HERE.items() if child(station, key) is not None]
        teams = [task for task in _crew_names(station, "tasks") if _team(tree, task) > 1]
        reasons += [f"task {shown(task)} of a team, and each job of a crew is in one pair of hands" for task in teams]
        reasons += ["a split, after which there is no job to go on with"] if node.value in splits else []
        if node.value in partners:
            reasons.append("tasks that it shares with another station, and nobody but its members works at a crew's")
        for reason in reasons:
            found = f"{node.value} has {reason}"
            yield problem(node.place, (*path, "stations", number), found, f"leave {node.value} out, or that")


def _ways(tree: Node, crew: Node, name: str) -> Iterator[Problem]:
    """Routes that come to the stations of a crew in another order than its own."""
    at = {station: number for number, station in enumerate(_crew_names(crew, "stations"))}
    for product, node in entries(tree, "products").items():
        furthest: tuple[int, str] = (-1, "")
        for number, step in enumerate(items(node, "route")):
            for station in one_of(step):
                if at.get(station, len(at)) <= furthest[0]:
                    found = f"{shown(station)} comes after {shown(furthest[1])}; in crew {name} it comes before"
                    hint = "jobs of a crew go along its stations once: change one of the two orders"
                    yield problem(step.place, ("products", product, "route", number), found, hint)
            here = [(at[station], station) for station in one_of(step) if station in at]
            furthest = max([furthest, *here])
        for station, row in entries(node, "routing").items():
            for after, place in onward(row):
                if at.get(after, len(at)) <= at.get(station, -1):
                    yield from _back(station, after, name, place, ("products", product, "routing", station, after))
    for station, before in at.items():
        rework = rework_at(entries(tree, "stations").get(station))
        if rework is not None and at.get(rework.value, before) < before:
            yield from _back(station, rework.value, name, rework, ("stations", station, "inspect", "then", "rework"))


def _back(station: str, after: str, crew: str, node: Node, path: TreePath) -> Iterator[Problem]:
    found = f"jobs would go back from {shown(station)} to {shown(after)}, and those of crew {crew} never do"
    yield problem(node.place, path, found, f"leave one of the two stations out of crew {crew}")


def _patrols(tree: Node) -> Iterator[Problem]:
    """Rounds are for people who choose by themselves where they work."""
    idle = child(tree, "allocation", "idle")
    if idle is not None and idle.value == "patrol" and entries(tree, "crews"):
        found = "with idle workers on patrol there can be no crews, whose members go with their jobs"
        yield problem(idle.place, ("allocation", "idle"), found, "write 'idle: stay', or leave the crews out")


def _team(tree: Node, task: str) -> int:
    node = child(tree, "tasks", task, "team")
    return node.value if node is not None and type(node.value) is int else 1


def _crew_names(block: Node, key: str) -> list[str]:
    return [node.value for node in items(block, key) if isinstance(node.value, str)]


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
