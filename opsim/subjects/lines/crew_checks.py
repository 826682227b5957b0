"""Crews: members and stations that exist, each in one crew, with nothing at the stations that a crew cannot do.

Their ways: jobs go along the line, by stations of the crew alone.
"""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.lookup import named, one_of, onward, rework_at
from opsim.scenario.tree import Node, TreePath, child, entries, items, problem, text

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
