"""What is wrong with a variant once changes are laid over it, said at these changes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from opsim.problems import Problem, ScenarioError
from opsim.scenario.changes import flow_text
from opsim.scenario.positions import Node, Part, problem
from opsim.scenario.varied import Varied


def change_problems(
    varied: Varied,
    changes: Mapping[str, Any],
    at: tuple[Part, ...] = (),
    origin: str = "changes",
    but: frozenset[Problem] = frozenset(),
) -> Iterator[Problem]:
    """What is wrong with a variant once some changes are laid over it, said at these changes.

    changes : dotted path -> plain value, or a Node that stands in a file. at : the way to them in that file
    but     : what is wrong without them, and is not said again
    """
    try:
        varied.with_changes(changes, origin=origin)
    except ScenarioError as error:
        places = {_line(place) for node in _nodes(changes) for place in (node.place, node.name_place)}
        for one in error.problems:
            if one not in but:
                near = not changes or one.file == origin or (one.file, one.line) in places
                yield one if near else _moved(one, changes, at)


def _nodes(changes: Mapping[str, Any]) -> list[Node]:
    return [value for value in changes.values() if isinstance(value, Node)]


def _line(place: Any) -> tuple[str, int]:
    return place.source.file, place.line + 1


def _moved(found: Problem, changes: Mapping[str, Any], at: tuple[Part, ...]) -> Problem:
    """A problem that the changes make elsewhere in the file."""
    said = ", ".join(f"{path}: {flow_text(value)}" for path, value in changes.items())
    message = f"with {said if len(said) < 80 else said[:77] + '...'}: {found.path}: {found.message}"
    for node in _nodes(changes):
        return problem(node.place, (*at, next(iter(changes))), message, found.hint)
    return replace(found, message=message, path="")
