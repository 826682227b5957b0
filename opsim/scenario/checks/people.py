"""Workers who are to move as a recorded person: somebody of that name was recorded."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.positions import Node, child, entries, problem
from opsim.scenario.recorded_people import recorded_people


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
