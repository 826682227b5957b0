"""What is wrong: members and stations that exist, members who can do something, posts that somebody can man.

What is risky: rotations that leave a station empty, with too few people for the posts, or nobody who can do the work.

What the assumption sheet says.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import NamedTuple

from opsim.engine.rules import ROTATION_RULES
from opsim.plan.calendar import together
from opsim.plan.compile import LEAST_EXPOSED
from opsim.plan.hours import Hours
from opsim.plan.plan import Plan
from opsim.plan.warnings.staffing import SHORT_S, station_names, worker_names
from opsim.problems import Problem, listed, shown
from opsim.scenario.checks.lookup import named
from opsim.scenario.checks.sequence import rule_problems
from opsim.scenario.tree import Node, Part, child, entries, items, problem
from opsim.subjects.rotations.words import IN_TURN, RotationPlan

TreePath = tuple[Part, ...]


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


class There(NamedTuple):
    """Who is on shift at once: members by their numbers in the list, and others by rank."""

    members: tuple[int, ...]
    others: frozenset[int]


def empty_posts(plan: Plan, hours: Hours, by_hand: set[int]) -> Iterator[str]:
    """For each rotation the stations at which too few people may work in some of its turns, at its worst hour."""
    for rotation in plan.rotations:
        stations = {rank for post in rotation.posts for rank in post} & by_hand
        found = [(there, _empty(plan, hours, rotation, there, stations)) for there in _who_are_there(hours, rotation)]
        there, empty = max(found, key=lambda pair: (sum(pair[1].values()), len(pair[0].members)), default=(None, {}))
        if there is not None and empty:
            n_turns = _turns(rotation, there)
            few = ""
            if len(there.members) < len(rotation.workers):
                names = worker_names(plan, [rotation.workers[member] for member in there.members])
                few = f" while of its members {names} {'is' if len(there.members) == 1 else 'are'} on shift alone"
            yield (
                f"rotation {rotation.name} leaves {station_names(plan, empty)} empty in {max(empty.values())} of its "
                f"{n_turns} turns{few} ({len(there.members)} people for {len(rotation.posts)} posts)"
            )


def _who_are_there(hours: Hours, rotation: RotationPlan) -> list[There]:
    """Who are on shift together, for at least some time of the run in all."""
    stations = {rank for post in rotation.posts for rank in post}
    ranks = sorted({*rotation.workers, *(worker for station in stations for worker in hours.able(station))})
    lasts_s: defaultdict[There, float] = defaultdict(float)
    for start_s, end_s, numbers in together(hours.on_duty[rank] for rank in ranks):
        there = {ranks[number] for number in numbers}
        members = tuple(n for n, worker in enumerate(rotation.workers) if worker in there)
        lasts_s[There(members, frozenset(there - {*rotation.workers}))] += end_s - start_s
    return [there for there, seconds in lasts_s.items() if there.members and seconds >= SHORT_S]


def _empty(plan: Plan, hours: Hours, rotation: RotationPlan, there: There, stations: set[int]) -> Counter[int]:
    """{station: in how many turns too few may work there}."""
    can = rotation.can([worker.rating for worker in plan.workers])
    everywhere, empty = (1 << len(plan.stations)) - 1, Counter[int]()
    for turn in range(_turns(rotation, there)):
        at = rotation.by_turns(there.members, turn, can)
        for station in stations:
            able = hours.able(station)
            mine = sum(
                1
                for member, post in at.items()
                if rotation.workers[member] in able and rotation.leaves(post, everywhere) >> station & 1
            )
            if mine + len(able & there.others) < hours.team(station):
                empty[station] += 1
    return empty


def _turns(rotation: RotationPlan, there: There) -> int:
    """After so many changes everybody is where he was."""
    return max(len(there.members), len(rotation.posts))


def rotations(plan: Plan) -> Iterator[tuple[str, str]]:
    """(topic, what is assumed) of each rotation."""
    new = ", and nobody is slower for being new at a post" if plan.human.learning is None else ""
    for rotation in plan.rotations:
        names = listed([plan.workers[worker].name for worker in rotation.workers])
        yield (
            "rotation",
            f"{rotation.name}: {names} share {len(rotation.posts)} posts, and change {_when(rotation)}, "
            f"{_who(rotation)}; what was begun is finished at the old post, a change takes no time but the walk{new}",
        )


def _when(rotation: RotationPlan) -> str:
    if rotation.every_s is not None:
        return f"every {rotation.every_s / 3600:g} h from the start of the run, work time or not"
    if rotation.after == 1:
        return "after every operation at one of the posts"
    return f"when {rotation.after} operations were done at one of the posts, by whomever"


def _who(rotation: RotationPlan) -> str:
    if rotation.rule == IN_TURN:
        return "each to the next post"
    if rotation.rule == "least_time":
        return "a post going to who was there for the shortest time so far, breaks included"
    if rotation.rule == LEAST_EXPOSED:
        return "the heaviest post going to whose body has gone through least so far"
    return f"by the rule {rotation.rule}"
