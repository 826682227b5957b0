"""``skills: {pack: expert}``: the name of a skill level stands for what it is in ``skill_levels``."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import MOST_FOUND, Problem, did_you_mean, shown
from opsim.scenario.positions import Node, Part, entries, problem
from opsim.scenario.yaml_nodes import scalar

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
