"""One override applied: each of its dotted paths replaces a value, or adds an entry with that name.

``overrides`` and ``scenarios``: the variants of a file, each a tree of its own.

Changes from elsewhere than the file, as a block of it: dotted paths and plain YAML values.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any

from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.fields import is_name, not_a_name
from opsim.scenario.paths import DEFAULTS, Spot, nearest_path, stands, step, top, words
from opsim.scenario.schema import Scenario
from opsim.scenario.schema.subjects import scenario_model
from opsim.scenario.templates import SECTIONS, WORKFORCE
from opsim.scenario.tree import Node, Place, Source, child, entries, items, problem, text
from opsim.scenario.yaml import Budget
from opsim.subjects.people.words import MOST_WORKERS, Worker


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
    wrong = _wrong_from(top(root), root, parts, new)
    if wrong is None or scenario_model() is Scenario:
        return wrong
    return _wrong_from(top(root, scenario_model()), root, parts, new)


def _wrong_from(spot: Spot, root: Node, parts: list[str], new: Node) -> tuple[str, str] | None:
    """The same of a path that begins at a spot."""
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


BASE = "base"
MOST_CHECKED = 10_000_000
"""Values of all variants together: some two minutes."""
MOST_COPIED = 200_000_000
"""Values times paths of overrides: some seconds."""
_NOT_IN_A_VARIANT = ("overrides", "scenarios")


def variants(root: Node, budget: Budget | None = None) -> tuple[Node, dict[str, Node], list[Problem]]:
    """The tree without overrides, that of every variant under ``scenarios`` ("base" where there are none), problems.

    Raises ScenarioError where there are so many, of so large a file, that reading them all would take minutes.
    """
    _refuse_too_many(root, (budget or Budget()).n_nodes + _n_drawn(root))
    problems = [*_wrong_shape(root, "overrides", "{near: {layout.places.rack: [6 m, 1 m]}}")]
    problems += _wrong_shape(root, "scenarios", "{base: [], near: [rack_near]}")
    base = root.with_entries({key: node for key, node in entries(root).items() if key not in _NOT_IN_A_VARIANT})
    overrides = entries(root, "overrides")
    problems += [*_bad_names(root, "overrides"), *_bad_names(root, "scenarios")]
    trees: dict[str, Node] = {}
    used: set[str] = set()
    for variant, wanted in entries(root, "scenarios").items():
        names, wrong = _names(variant, wanted, overrides)
        used.update(names)
        trees[variant] = base
        for name in names:
            trees[variant], more = applied(trees[variant], overrides[name], ("overrides", name))
            wrong += more
        problems += wrong
        if len(problems) > MOST_FOUND:
            raise ScenarioError(sorted(problems))
    for name in overrides.keys() - used:
        problems += applied(base, overrides[name], ("overrides", name))[1]
    return base, trees or {BASE: base}, problems


def _n_drawn(root: Node) -> int:
    """Values that the workers of a workforce may come to."""
    overrides = [path for override in entries(root, "overrides").values() for path in entries(override)]
    has_one = "workforce" in entries(root) or any(path.startswith("workforce") for path in overrides)
    return MOST_WORKERS * len(Worker.model_fields) if has_one else 0


def _refuse_too_many(root: Node, n_nodes: int) -> None:
    """Every variant is checked as a whole, and every path of an override copies the blocks on its way."""
    overrides, scenarios = entries(root, "overrides"), entries(root, "scenarios")
    n_paths = {name: len(entries(node)) for name, node in overrides.items()}
    n_applied = sum(n_paths.values()) + sum(
        n_paths.get(name.value, 0) if isinstance(name.value, str) else 1
        for wanted in scenarios.values()
        for name in items(wanted)
    )
    for section, n, most in (("scenarios", len(scenarios), MOST_CHECKED), ("overrides", n_applied, MOST_COPIED)):
        if n * n_nodes > most:
            node = entries(root)[section]
            found = f"{n:,} {section} in files of {n_nodes:,} values are more than can be checked"
            raise ScenarioError([problem(node.name_place, (section,), found, "spread them over several files")])


def _names(variant: str, wanted: Node, overrides: dict[str, Node]) -> tuple[list[str], list[Problem]]:
    """The overrides a variant asks for, in its order, and those that do not exist."""
    if not isinstance(wanted.value, list):
        hint = f"write {variant}: [{wanted.value}]" if isinstance(wanted.value, str) else "such as [rack_near], or []"
        found = f"expected a list of overrides, found {shown(wanted.value)}"
        return [], [problem(wanted.place, ("scenarios", variant), found, hint)]
    names = [node.value for node in items(wanted) if isinstance(node.value, str) and node.value in overrides]
    unknown = (node for node in items(wanted) if not isinstance(node.value, str) or node.value not in overrides)
    wrong = [
        problem(
            node.place,
            ("scenarios", variant),
            f"no override {shown(node.value)}",
            did_you_mean(node.value, overrides) or "there are no overrides in this file",
        )
        for node in islice(unknown, MOST_FOUND)
    ]
    return names, wrong


def _bad_names(root: Node, section: str) -> list[Problem]:
    """A variant's name becomes that of a folder, so it is held to the same rule as all names."""
    found = {name: node for name, node in entries(root, section).items() if not is_name(name)}
    return [problem(node.name_place, (section, name), *not_a_name(name)) for name, node in found.items()]


def _wrong_shape(root: Node, section: str, example: str) -> list[Problem]:
    node = entries(root).get(section)
    if node is None or isinstance(node.value, dict):
        return []
    found = f"expected a block of names, found {shown(node.value)}"
    return [problem(node.name_place, (section,), found, f"such as {section}: {example}")]


def changes_node(changes: Mapping[str, Any], origin: str = "changes") -> Node:
    """Changes as an override would have them, a line each, so that what is wrong with them has a place too.

    origin : where they come from, such as "--vary", in place of the name of a file. A value that is a Node keeps its
             own place. They come by name, so that the order in which they were given decides nothing.
    """
    source = Source(origin, tuple(f"{path}: {flow_text(value)}" for path, value in changes.items()))
    nodes = {
        path: value
        if isinstance(value, Node)
        else _node(value, Place(source, line, len(path) + 2), Place(source, line, 0))
        for line, (path, value) in enumerate(changes.items())
    }
    return Node(dict(sorted(nodes.items())), Place(source, 0, 0))


def flow_text(value: Any) -> str:
    """A plain value in a line of YAML, as people write it: ``[6 m, 1 m]``, ``{like: ana}``, ``true``."""
    if isinstance(value, Node):
        return flow_text(value.plain())
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{name}: {flow_text(below)}" for name, below in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(flow_text, value)) + "]"
    if value is None or isinstance(value, bool):
        return {None: "null", True: "true", False: "false"}[value]
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _node(value: Any, place: Place, key: Place | None = None) -> Node:
    """A plain value as a tree; everything in it stands where the whole stands."""
    if isinstance(value, Mapping):
        return Node({str(name): _node(below, place, place) for name, below in value.items()}, place, key)
    if isinstance(value, list | tuple):
        return Node([_node(below, place) for below in value], place, key)
    return Node(value, place, key)
