"""A scenario file -> its variants, checked: YAML, overrides, likes, schema, cross references; all problems at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from opsim.collecting import without_collecting
from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.checks import check_problems
from opsim.scenario.include import with_includes
from opsim.scenario.like import without_likes
from opsim.scenario.overrides import applied
from opsim.scenario.plain_words import schema_problems
from opsim.scenario.positions import Node, Place, Source, problem, written_paths
from opsim.scenario.schema import Scenario
from opsim.scenario.skill_levels import with_ratings
from opsim.scenario.variants import variants
from opsim.scenario.workforce import with_workforce, without_workforce
from opsim.scenario.yaml_nodes import Budget, read_tree
from opsim.scenario.yaml_text import read_bytes
from opsim.shipped import find_scenario


@dataclass(frozen=True)
class Loaded:
    """One variant of a scenario file, ready to plan.

    given    : the dotted paths that stand in the file (after ``like`` and overrides), e.g. "workers.ana.walk"
    resolved : the variant as plain values, quantities still as text, for scenario.resolved.yaml
    """

    scenario: Scenario
    variant: str
    file: Path
    folder: Path
    given: frozenset[str]
    resolved: dict[str, Any]


def read_scenarios(
    path: str | Path, names: Sequence[str] | None = None, changes: Mapping[str, str | int] | None = None
) -> dict[str, Loaded]:
    """The variants of a scenario file by name, in the file's order; with ``names`` those only, in that order.

    A path that does not exist may be the name of a shipped scenario. All variants are checked.
    changes : dotted paths and values from elsewhere, such as {"run.horizon": "4 h"}, laid over every variant.
    Raises ScenarioError with every problem found.
    """
    file = find_scenario(path)
    return scenarios_in(read_bytes(file), file, names, changes)


@without_collecting()
def scenarios_in(
    raw: bytes, file: Path, names: Sequence[str] | None = None, changes: Mapping[str, str | int] | None = None
) -> dict[str, Loaded]:
    """As ``read_scenarios``, from the bytes of a file; ``file`` names it and places the files it mentions."""
    budget = Budget()
    root, problems = read_tree(raw, str(file), budget)
    if not isinstance(root.value, dict):
        found = f"expected a scenario, found {shown(root.value)}"
        raise ScenarioError([*problems, problem(root.place, "", found, "a scenario begins with 'opsim: 1'")])
    root, more = with_includes(root, file, budget)
    problems += more
    base, trees, more = variants(root, budget)
    problems += more
    loaded: dict[str, Loaded] = {}
    for variant, tree in trees.items():
        tree, wrong = applied(tree, "changes", _as_override(changes or {}))
        problems += wrong
        scenario, tree, found_here = _checked(tree, base, file.parent)
        problems += found_here
        if scenario is not None:
            given = frozenset(written_paths(tree))
            resolved = without_workforce(tree).plain()
            loaded[variant] = Loaded(scenario, variant, file, file.parent, given, resolved)
    if problems:
        raise ScenarioError(sorted(_unheard(problems)))
    return loaded if names is None else _chosen(loaded, names, file)


def _as_override(changes: Mapping[str, str | int]) -> Node:
    """Changes as a block of their own, a line each, so that what is wrong with them has a place too."""
    source = Source("changes", tuple(f"{path}: {value}" for path, value in changes.items()))
    nodes = {
        path: Node(value, Place(source, line, len(path) + 2), Place(source, line, 0))
        for line, (path, value) in enumerate(changes.items())
    }
    return Node(nodes, Place(source, 0, 0))


def _checked(tree: Node, base: Node, folder: Path) -> tuple[Scenario | None, Node, list[Problem]]:
    """A variant's scenario (None where the schema refuses it), its tree without likes, and its problems."""
    tree, problems = without_likes(tree)
    for step in (with_ratings, partial(with_workforce, folder=folder)):
        tree, more = step(tree)
        problems += more
    scenario: Scenario | None = None
    schema_found: Iterator[Problem] = iter(())
    try:
        scenario = Scenario.model_validate(tree.plain())
    except ValidationError as error:
        unlike = {one.path.removesuffix(".like") for one in problems if one.path.endswith(".like")}
        schema_found = schema_problems(error, tree, unlike)
    found = islice(_unheard(chain(schema_found, check_problems(tree, base, folder))), MOST_FOUND)
    return scenario, tree, [*problems, *found]


def _unheard(problems: Iterable[Problem]) -> Iterator[Problem]:
    """Each place and message once: variants, likes and defaults repeat what they share."""
    heard: set[tuple[str, int, int, str]] = set()
    for one in problems:
        said = (one.file, one.line, one.column, one.message)
        if said not in heard:
            heard.add(said)
            yield one


def _chosen(loaded: dict[str, Loaded], names: Sequence[str], file: Path) -> dict[str, Loaded]:
    unknown = [name for name in names if name not in loaded]
    if unknown:
        raise ScenarioError(
            Problem(str(file), 0, 0, "", f"no scenario {shown(name)} in this file", did_you_mean(name, loaded))
            for name in unknown
        )
    return {name: loaded[name] for name in names}
