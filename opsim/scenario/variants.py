"""``overrides`` and ``scenarios``: the variants of a file, each a tree of its own."""

from __future__ import annotations

from itertools import islice

from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.fields import is_name, not_a_name
from opsim.scenario.overrides import applied
from opsim.scenario.positions import Node, entries, items, problem
from opsim.scenario.schema.workers import MOST_WORKERS, Worker
from opsim.scenario.yaml_nodes import Budget

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
