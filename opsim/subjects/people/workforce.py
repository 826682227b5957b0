"""``skills: {pack: expert}``: the name of a skill level stands for what it is in ``skill_levels``.

``workforce: {n: 12}``: so many workers more, all with the same keys: people drawn, or people who were recorded.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.problems import MOST_FOUND, Problem, did_you_mean, listed, shown
from opsim.scenario.fields import is_name
from opsim.scenario.tree import Node, Part, child, entries, problem, text
from opsim.scenario.yaml import scalar
from opsim.subjects.people.checks import recorded_people
from opsim.subjects.people.words import MOST_WORKERS, PREFIX

_ANY = 1.0
"""Stands for a level that does not exist, so that it is one mistake and not two."""


def with_ratings(root: Node) -> tuple[Node, list[Problem]]:
    """The tree with a pace, or pace and quality, for every level that skills name, and the names that are no level."""
    levels = entries(root, "skill_levels")
    problems: list[Problem] = []
    top = dict(entries(root))
    if entries(root, "workers"):
        rated = {
            name: _rated(worker, levels, ("workers", name), problems)
            for name, worker in entries(top["workers"]).items()
        }
        top["workers"] = top["workers"].with_entries(rated)
    if entries(root, "workforce"):
        top["workforce"] = _rated(top["workforce"], levels, ("workforce",), problems)
    return root.with_entries(top), problems


def _rated(worker: Node, levels: dict[str, Node], path: tuple[Part, ...], problems: list[Problem]) -> Node:
    skills = entries(worker, "skills")
    named = dict(_named(skills))
    if not named:
        return worker
    for station, node in named.items():
        if node.value not in levels and len(problems) < MOST_FOUND:
            problems.append(_no_level(node, levels, (*path, "skills", station)))
    ratings = {station: Node(_rating(levels.get(node.value)), node.place, node.key) for station, node in named.items()}
    block = worker.value["skills"].with_entries({**skills, **ratings})
    return worker.with_entries({**worker.value, "skills": block})


def _named(skills: dict[str, Node]) -> Iterator[tuple[str, Node]]:
    """The skills that are words; a number in quotes is a mistake of its own."""
    for station, node in skills.items():
        if isinstance(node.value, str) and isinstance(scalar(node.value), str):
            yield station, node


def _rating(level: Node | None) -> object:
    """A number, or the entries of a block; what the schema refuses stands for anything."""
    known = level is not None and isinstance(level.value, int | float | dict) and not isinstance(level.value, bool)
    return level.value if known and level is not None else _ANY


def _no_level(node: Node, levels: dict[str, Node], path: tuple[Part, ...]) -> Problem:
    """A word that is no level; where there are none, a number was wanted."""
    if not levels:
        hint = "write a number such as 1.1, or name a level: 'skill_levels: {expert: 1.15}'"
        return problem(node.place, path, f"expected a number, found {shown(node.value)}", hint)
    hint = did_you_mean(node.value, levels, otherwise="skill levels")
    return problem(node.place, path, f"no skill level {shown(node.value)}", hint)


_NOT_OF_EACH = ("n", "from", "prefix", "person")
"""Keys of a workforce that are not those of each of its workers; ``person`` is a mistake that the schema tells of."""


def with_workforce(root: Node, folder: Path) -> tuple[Node, list[Problem]]:
    """The tree with the workers of the workforce beside the named ones, ``like`` and skill levels already applied.

    What the schema refuses is passed over here. The block itself stays, for the schema to read.
    """
    block = child(root, "workforce")
    if block is None or not isinstance(block.value, dict):
        return root, []
    named = entries(root, "workers")
    names = [f"{_prefix(block)}{number}" for number in range(1, _n(block) + 1)]
    persons, problems = _persons(root, block, len(names), folder)
    problems += [_clash(block, name) for name in names if name in named][:1]
    template = _template(root, block)
    drawn = {
        name: Node({**template, **person}, block.place, block.key)
        for name, person in zip(names, persons)
        if name not in named
    }
    section = child(root, "workers") or block
    return root.with_entries({**entries(root), "workers": section.with_entries({**named, **drawn})}), problems


def without_workforce(root: Node) -> Node:
    """The tree as it is once its workers stand in it by name."""
    return root.with_entries({key: node for key, node in entries(root).items() if key != "workforce"})


def _template(root: Node, block: Node) -> dict[str, Node]:
    """The keys of each worker; who has no skills said has the rating 1 everywhere."""
    keys = {key: node for key, node in entries(block).items() if key not in _NOT_OF_EACH}
    if "skills" not in keys:
        everywhere = {station: Node(1.0, block.place, block.key) for station in entries(root, "stations")}
        keys["skills"] = Node(everywhere, block.place, block.key)
    return keys


def _n(block: Node) -> int:
    """How many; one where the schema refuses the number, so that nothing else is found wrong for lack of people."""
    n = child(block, "n")
    whole = n is not None and isinstance(n.value, int) and not isinstance(n.value, bool)
    return n.value if whole and n is not None and 1 <= n.value <= MOST_WORKERS else 1


def _prefix(block: Node) -> str:
    said = text(block, "prefix")
    return said if said is not None and is_name(said) else PREFIX


def _clash(block: Node, name: str) -> Problem:
    key = "prefix" if child(block, "prefix") is not None else "n"
    node = child(block, key) or block
    found = f"the workforce makes a worker {shown(name)}, and a worker has that name already"
    return problem(node.place, ("workforce", key), found, "give the workforce another prefix, such as 'prefix: p'")


def _persons(root: Node, block: Node, n: int, folder: Path) -> tuple[list[dict[str, Node]], list[Problem]]:
    """For each worker the recorded person he is: the k-th worker is the k-th person, whoever else there is."""
    source = child(block, "from")
    people = recorded_people(root, folder) if source is not None and source.value == "recorded" else None
    if source is None or people is None:
        return [{}] * n, []
    persons = [{"person": Node(person, source.place, source.key)} for person in people[:n]]
    wrong = [*_too_few(block, source, n, len(people)), *_twice(root, source, people[:n])]
    return [*persons, *[{}] * (n - len(persons))], wrong


def _too_few(block: Node, source: Node, n: int, n_people: int) -> Iterator[Problem]:
    if not n_people:
        found = "nobody was recorded for the tasks of this scenario"
        hint = "no task is emulated; take 'from: population'"
        yield problem(source.place, ("workforce", "from"), found, hint)
    elif n > n_people:
        found = f"{n} workers, and {n_people} people were recorded for the tasks of this scenario"
        yield problem((child(block, "n") or block).place, ("workforce", "n"), found, "or take 'from: population'")


def _twice(root: Node, source: Node, people: list[str]) -> Iterator[Problem]:
    """People whom the workforce takes and who are workers by name.

    NOTE: passing them over would make every later worker another person, so a worker more would change the others.
    """
    named = {name: text(worker, "person") for name, worker in entries(root, "workers").items()}
    already = [(person, name) for name, person in named.items() if person in people]
    if already:
        found = f"the workforce takes {_so_many(people)}, and {listed(f'{p} is {name} already' for p, name in already)}"
        hint = f"give {listed(dict.fromkeys(name for _, name in already))} another person, or take 'from: population'"
        yield problem(source.place, ("workforce", "from"), found, hint)


def _so_many(people: list[str]) -> str:
    return people[0] if len(people) == 1 else f"{people[0]} to {people[-1]}"
