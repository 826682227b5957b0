"""One override applied: each of its dotted paths replaces a value, or adds an entry with that name."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from opsim.problems import Problem, did_you_mean, shown
from opsim.scenario.known_paths import DEFAULTS, Spot, stands, step, top, words
from opsim.scenario.like import SECTIONS, WORKFORCE
from opsim.scenario.nearest_path import nearest_path
from opsim.scenario.positions import Node, child, entries, problem, text


def applied(root: Node, override: Node, at: tuple[str, ...] = ()) -> tuple[Node, list[Problem]]:
    """The tree with an override applied, and the paths that lead nowhere (at their lines in the override).

    at : where the override stands in its file, which begins the paths of its problems
    The order of its paths decides nothing: a path inside that of another goes over it.
    """
    if not isinstance(override.value, dict):
        found = f"expected a block of paths and values, found {shown(override.value)}"
        hint = "such as {layout.places.rack: [6 m, 1 m]}"
        return root, [problem(override.place, at, found, hint)]
    problems: list[Problem] = []
    changes = [(path.split("."), node) for path, node in entries(override).items()]
    copying = [change for change in changes if _may_copy(change[0])]
    for parts, node in sorted((one for one in changes if not _may_copy(one[0])), key=lambda one: len(one[0])):
        root = _one_applied(root, parts, node, at, problems)
    for parts, node in sorted(copying, key=lambda one: (_n_copies(root, one[0]), len(one[0]))):
        root = _one_applied(root, parts, node, at, problems)
    return root, sorted(problems)


def _may_copy(parts: Sequence[str]) -> bool:
    """Whether a path reaches into a key of an entry, which may be that of the entry it is like: what it changes a part
    of must have been changed before.
    """
    return len(parts) > (2 if parts[0] == WORKFORCE else 3)


def _n_copies(root: Node, parts: Sequence[str]) -> int:
    """How many entries stand below the one a path changes: none for defaults, then along ``like``, a workforce last."""
    if parts[0] not in (*SECTIONS, WORKFORCE):
        return 0
    section = "workers" if parts[0] == WORKFORCE else parts[0]
    entry = child(root, WORKFORCE) if parts[0] == WORKFORCE else child(root, section, parts[1])
    return 1 + len(list(_likes(root, section, entry)))


def _one_applied(root: Node, parts: list[str], new: Node, at: tuple[str, ...], problems: list[Problem]) -> Node:
    wrong = _wrong_path(root, parts, new)
    if wrong is None:
        return _replaced(root, root, (), parts, new)
    problems.append(problem(new.name_place, (*at, ".".join(parts)), *wrong))
    return root


def _replaced(root: Node, node: Node, passed: tuple[str, ...], parts: list[str], new: Node) -> Node:
    """The node with ``new`` at the end of the remaining parts of the path; ``passed`` is the way from the root."""
    inside = entries(node)
    if len(parts) == 1:
        return node.with_entries({**inside, parts[0]: new})
    below = inside.get(parts[0]) or _inherited(root, node, passed, parts[0]) or replace(new, value={})
    return node.with_entries({**inside, parts[0]: _replaced(root, below, (*passed, parts[0]), parts[1:], new)})


def _inherited(root: Node, node: Node, passed: tuple[str, ...], key: str) -> Node | None:
    """What the key says in the entry that this one is like, or in the defaults, so that a part of it can be changed."""
    section = "workers" if passed == (WORKFORCE,) else passed[0] if len(passed) == 2 else ""
    if section not in SECTIONS:
        return None
    copied = (entries(entry) for entry in _likes(root, section, node))
    found = next((keys[key] for keys in copied if key in keys), None)
    return child(root, DEFAULTS, section, key) if found is None else found


def _likes(root: Node, section: str, entry: Node | None) -> Iterator[Node]:
    """The entries that one is like, the next one first; a circle is gone round once."""
    seen: set[str] = set()
    other = text(entry, "like")
    while other is not None and other not in seen:
        seen.add(other)
        copied = child(root, section, other)
        if copied is None:
            return
        yield copied
        other = text(copied, "like")


def _wrong_path(root: Node, parts: list[str], new: Node) -> tuple[str, str] | None:
    """What is wrong with a path and the way out; None where it leads somewhere, or adds an entry."""
    spot = top(root)
    for number, part in enumerate(parts):
        wrong = _no_part(root, part, parts) or _closed(spot)
        if wrong is not None:
            return wrong
        below = step(root, spot, part)
        if below is None:
            return _nothing_there(root, spot, parts, number)
        is_last = number == len(parts) - 1
        if not stands(root, spot, part) and not _may_be_new(below, None if is_last else {}, new):
            return _nothing_there(root, spot, parts, number)
        spot = below
    return None


def _may_be_new(below: Spot, inside: dict | None, new: Node) -> bool:
    """Whether an entry that is not there may be made: whole; names of numbers or lists also on the way."""
    if not below.blocks:
        return True
    whole = isinstance(new.value, dict) or len(below.blocks) < len(below.shapes)
    return inside is None and whole


def _closed(spot: Spot) -> tuple[str, str] | None:
    """Of a spot in which nothing lies."""
    where = ".".join(spot.path)
    value = None if spot.node is None else spot.node.value
    if isinstance(value, list) or (value is None and spot.only_a_list):
        return f"{where} is a list; its parts cannot be replaced one by one", f"give the whole list at {where}"
    if value is not None and not isinstance(value, dict):
        return f"{where} is {shown(value)}; nothing lies inside it", f"give a new value at {where}"
    if value is None and not spot.may_hold:
        return f"nothing lies inside {where}", f"give a value at {where}"
    return None


def _no_part(root: Node, part: str, parts: list[str]) -> tuple[str, str] | None:
    if part and "[" not in part:
        return None
    found = f"{shown(part)} cannot be a part of a path" if part else "a part of this path is empty"
    without = [one.partition("[")[0].strip() for one in parts]
    near = nearest_path(root, [one for one in without if one])
    if "[" in part:
        return found, f"a list is replaced whole{f': give {near}' if near else ''}"
    return found, _mean(near) or "a path is written like workers.ana.walk"


def _nothing_there(root: Node, spot: Spot, parts: list[str], number: int) -> tuple[str, str]:
    """A part that is no key and no name where it stands."""
    where = ".".join(spot.path)
    if not where:
        found = f"no {shown(parts[number])} in a scenario"
    elif spot.by_name and len(spot.path) == 1:
        found = f"no {shown(parts[number])} among the {where}"
    else:
        found = f"no {shown(parts[number])} in {where}"
    hint = _mean(nearest_path(root, parts)) or did_you_mean(parts[number], words(root, spot))
    return found, hint or f"to add one, write {'.'.join(parts[: number + 1])}: {{...}}"


def _mean(near: str | None) -> str:
    return f"did you mean {near}?" if near else ""
