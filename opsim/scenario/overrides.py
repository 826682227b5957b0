"""One override applied: each of its dotted paths replaces a value, or adds an entry with that name."""

from __future__ import annotations

from dataclasses import replace

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.like import SECTIONS, WORKFORCE
from opsim.scenario.positions import Node, child, entries, problem, text
from opsim.scenario.schema import Scenario

# Keys of the file an override may begin with.
_BEGINNINGS = sorted({*Scenario.model_fields, "defaults"} - {"opsim"})


class _NoWay(Exception):
    """A path that does not lead anywhere: what is wrong, and the way out."""


def applied(root: Node, name: str, override: Node) -> tuple[Node, list[Problem]]:
    """The tree with an override applied, and the paths that lead nowhere (at their lines in the override)."""
    if not isinstance(override.value, dict):
        found = f"expected a block of paths and values, found {shown(override.value)}"
        hint = "such as {layout.places.rack: [6 m, 1 m]}"
        return root, [problem(override.place, ("overrides", name), found, hint)]
    problems: list[Problem] = []
    for path, node in entries(override).items():
        try:
            root = _replaced(root, root, (), path.split("."), node)
        except _NoWay as error:
            message, hint = error.args
            problems.append(problem(node.name_place, ("overrides", name, path), message, hint))
    return root, problems


def _replaced(root: Node, node: Node, passed: tuple[str, ...], parts: list[str], new: Node) -> Node:
    """The node with ``new`` at the end of the remaining parts of the path; ``passed`` is the way from the root."""
    _check_step(node, passed, parts[0])
    inside = entries(node)
    if len(parts) == 1:
        return node.with_entries({**inside, parts[0]: new})
    below = inside.get(parts[0]) or _inherited(root, node, passed, parts[0])
    if below is None:
        if len(passed) == 1 and passed[0] in SECTIONS:
            raise _NoWay(f"no {shown(parts[0])} among the {passed[0]}", did_you_mean(parts[0], inside))
        below = replace(new, value={})
    return node.with_entries({**inside, parts[0]: _replaced(root, below, (*passed, parts[0]), parts[1:], new)})


def _check_step(node: Node, passed: tuple[str, ...], part: str) -> None:
    where = ".".join(passed)
    if not part or "[" in part:
        hint = "a list is replaced whole" if "[" in part else "a path is written like workers.ana.walk"
        raise _NoWay(f"{shown(part)} cannot be a part of a path", hint)
    if not passed and part not in _BEGINNINGS:
        raise _NoWay(f"no {shown(part)} in a scenario", did_you_mean(part, _BEGINNINGS))
    if isinstance(node.value, list):
        raise _NoWay(f"{where} is a list; its parts cannot be replaced one by one", f"give the whole list at {where}")
    if not isinstance(node.value, dict) and node.value is not None:
        raise _NoWay(f"{where} is {shown(node.value)}; nothing lies inside it", f"give a new value at {where}")


def _inherited(root: Node, node: Node, passed: tuple[str, ...], key: str) -> Node | None:
    """What the key says in the entry that this one is like, or in the defaults, so that a part of it can be changed."""
    section = "workers" if passed == (WORKFORCE,) else passed[0] if len(passed) == 2 else ""
    if section not in SECTIONS:
        return None
    seen: set[str] = set()
    other = text(node, "like")
    while other is not None and other not in seen:
        seen.add(other)
        copied = entries(root, section, other)
        if key in copied:
            return copied[key]
        other = copied["like"].value if "like" in copied and isinstance(copied["like"].value, str) else None
    return child(root, "defaults", section, key)
