"""A scenario file -> its variants, checked: YAML, overrides, likes, schema, cross references; all problems at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from opsim.problems import MOST_FOUND, Problem, ScenarioError, did_you_mean, shown
from opsim.scenario.checks.table import check_problems
from opsim.scenario.messages import schema_problems
from opsim.scenario.schema import Scenario
from opsim.scenario.schema.scenario import Loaded
from opsim.scenario.schema.subjects import scenario_model, subject_problems
from opsim.scenario.templates import with_includes, without_likes
from opsim.scenario.tree import Node, problem, written_paths
from opsim.scenario.variants import applied, changes_node, variants
from opsim.scenario.yaml import Budget, read_bytes, read_tree
from opsim.shipped import find_scenario
from opsim.subjects.people.workforce import with_ratings, with_workforce, without_workforce
from opsim.threads import without_collecting

T = TypeVar("T")


def read_scenarios(
    path: str | Path,
    names: Sequence[str] | None = None,
    changes: Mapping[str, Any] | None = None,
    origin: str = "changes",
) -> dict[str, Loaded]:
    """The variants of a scenario file by name, in the file's order; with ``names`` those only, in that order.

    A path that does not exist may be the name of a shipped scenario. All variants are checked.
    changes : dotted paths and values from elsewhere, such as {"run.horizon": "4 h"}, laid over every variant
    origin  : where they come from, such as "command line": what is wrong with them is said to stand there
    Raises ScenarioError with every problem found.
    """
    file = find_scenario(path)
    return scenarios_in(read_bytes(file), file, names, changes, origin)


@without_collecting()
def scenarios_in(
    raw: bytes,
    file: Path,
    names: Sequence[str] | None = None,
    changes: Mapping[str, Any] | None = None,
    origin: str = "changes",
) -> dict[str, Loaded]:
    """As ``read_scenarios``, from the bytes of a file; ``file`` names it and places the files it mentions."""
    base, trees, problems = _trees(raw, file)
    loaded: dict[str, Loaded] = {}
    for variant, tree in trees.items():
        tree, wrong = applied(tree, changes_node(changes or {}, origin))
        problems += wrong
        scenario, tree, found_here = _checked(tree, base, file.parent)
        problems += found_here
        if scenario is not None:
            loaded[variant] = _loaded(scenario, tree, file, variant)
    if problems:
        raise ScenarioError(sorted(_unheard(problems)))
    return loaded if names is None else _chosen(loaded, names, file)


def variant_trees(file: Path, variant: str | None = None) -> tuple[str, dict[str, Node], Node]:
    """(name of the variant, by default the first; the trees of all; the tree without overrides); nothing in them is
    checked.

    Raises ScenarioError with what is wrong with the file's text and its variants.
    """
    base, trees, problems = _trees(read_bytes(file), file)
    if problems:
        raise ScenarioError(sorted(problems))
    return next(iter(trees if variant is None else _chosen(trees, [variant], file))), trees, base


def loaded_of(tree: Node, base: Node, file: Path, variant: str) -> Loaded:
    """The tree of a variant, checked. Raises ScenarioError with all that is wrong with it."""
    scenario, tree, problems = _checked(tree, base, file.parent)
    if scenario is None or problems:
        raise ScenarioError(sorted(_unheard(problems)))
    return _loaded(scenario, tree, file, variant)


def _loaded(scenario: Scenario, tree: Node, file: Path, variant: str) -> Loaded:
    resolved = without_workforce(tree).plain()
    return Loaded(scenario, variant, file, file.parent, frozenset(written_paths(tree)), resolved)


def _trees(raw: bytes, file: Path) -> tuple[Node, dict[str, Node], list[Problem]]:
    """The tree without overrides, that of every variant, and what is wrong with the file as a text."""
    budget = Budget()
    root, problems = read_tree(raw, str(file), budget)
    if not isinstance(root.value, dict):
        found = f"expected a scenario, found {shown(root.value)}"
        raise ScenarioError([*problems, problem(root.place, "", found, "a scenario begins with 'opsim: 1'")])
    root, of_includes = with_includes(root, file, budget)
    base, trees, of_variants = variants(root, budget)
    return base, trees, [*problems, *of_includes, *of_variants]


def _checked(tree: Node, base: Node, folder: Path) -> tuple[Scenario | None, Node, list[Problem]]:
    """A variant's scenario (None where the schema refuses it), its tree without likes, and its problems."""
    tree, problems = without_likes(tree)
    for step in (with_ratings, partial(with_workforce, folder=folder)):
        tree, more = step(tree)
        problems += more
    scenario: Scenario | None = None
    schema_found: Iterator[Problem] = iter(())
    try:
        scenario = _validated(tree.plain())
        schema_found = subject_problems(scenario, tree)
    except ValidationError as error:
        unlike = {one.path.removesuffix(".like") for one in problems if one.path.endswith(".like")}
        schema_found = schema_problems(error, tree, unlike)
    found = islice(_unheard(chain(schema_found, check_problems(tree, base, folder))), MOST_FOUND)
    return scenario, tree, [*problems, *found]


def _validated(plain: dict[str, Any]) -> Scenario:
    """By our own words where they are enough, else with those of subjects that are installed."""
    try:
        return Scenario.model_validate(plain)
    except ValidationError:
        if scenario_model() is Scenario:
            raise
    return scenario_model().model_validate(plain)


def _unheard(problems: Iterable[Problem]) -> Iterator[Problem]:
    """Each place and message once: variants, likes and defaults repeat what they share."""
    heard: set[tuple[str, int, int, str]] = set()
    for one in problems:
        said = (one.file, one.line, one.column, one.message)
        if said not in heard:
            heard.add(said)
            yield one


def _chosen(loaded: dict[str, T], names: Sequence[str], file: Path) -> dict[str, T]:
    unknown = [name for name in names if name not in loaded]
    if unknown:
        raise ScenarioError(
            Problem(str(file), 0, 0, "", f"no scenario {shown(name)} in this file", did_you_mean(name, loaded))
            for name in unknown
        )
    return {name: loaded[name] for name in names}
