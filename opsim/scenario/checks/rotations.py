"""Job rotations: members and stations that exist, members who can do something there, posts that somebody can man."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.engine.rules import ROTATION_RULES
from opsim.problems import Problem, shown
from opsim.scenario.checks.references import named
from opsim.scenario.checks.sequence import rule_problems
from opsim.scenario.positions import Node, Part, child, entries, items, problem

Path = tuple[Part, ...]


def rotation_problems(tree: Node) -> Iterator[Problem]:
    """What is wrong with the rotations of a scenario."""
    seen: dict[str, str] = {}
    for name, rotation in entries(tree, "rotations").items():
        path = ("rotations", name)
        yield from _members(tree, rotation, path, seen)
        yield from _posts(tree, rotation, path)
        yield from rule_problems(child(rotation, "rule"), (*path, "rule"), "opsim.rotation", ROTATION_RULES)


def _members(tree: Node, rotation: Node, path: Path, seen: dict[str, str]) -> Iterator[Problem]:
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


def _posts(tree: Node, rotation: Node, path: Path) -> Iterator[Problem]:
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
