"""Stations, stores and conveyors are steps of the same routes: no two of them have one name."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.problems import Problem, shown
from opsim.scenario.checks.ways import POINTS
from opsim.scenario.positions import Node, entries, problem


def point_problems(tree: Node) -> Iterator[Problem]:
    """Names that stand in two of the sections."""
    section_of: dict[str, str] = {}
    for section in POINTS:
        for name, node in entries(tree, section).items():
            other = section_of.setdefault(name, section)
            if other != section:
                found = f"{shown(name)} is the name of one of the {other} too"
                yield problem(node.name_place, (section, name), found, "a route could not tell them apart")
