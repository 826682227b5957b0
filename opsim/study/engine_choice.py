"""The engine of each variant of a scenario; what the fast one does not run is said with its place, all at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from opsim.engine.choice import Choice, NotFast, Refusal, Told, choose, make_ready
from opsim.plan import Plan
from opsim.problems import Problem, ScenarioError
from opsim.scenario.like import without_likes
from opsim.scenario.positions import Node, child, problem

Chosen = Callable[[Choice], Told | None]
"""Is told which engine is used; what it gives back, if anything, is told how far the compiling is."""
HINT = "--engine simpy runs it, and --engine auto finds that out by itself"


def engine_of(asked: str | Choice, loaded: Any, plan: Plan, runs: int = 1) -> Choice:
    """The engine of one variant; a Choice stays what it is. Raises ScenarioError, ValueError for an unknown word."""
    return asked if isinstance(asked, Choice) else engines_of(asked, {"": (loaded, plan)}, runs)[""]


def engines_of(asked: str, variants: Mapping[str, tuple[Any, Plan]], runs: int = 1) -> dict[str, Choice]:
    """The engine of each variant, (as read, its Plan) by name, of which ``runs`` replications each are to be run.

    Raises ScenarioError with everything in them that the fast engine does not run, where it is asked for.
    """
    found, wrong = {}, list[Problem]()
    for name, (loaded, plan) in variants.items():
        try:
            found[name] = choose(asked, plan, runs * len(variants))
        except NotFast as error:
            wrong += problems_of(error, tree_of(loaded), loaded.file)
    if wrong:
        raise ScenarioError(dict.fromkeys(wrong))
    return found


def compiled_for(choice: Choice, plan: Plan, chosen: Chosen | None) -> None:
    """Tell of a choice, and make it ready for a Plan."""
    make_ready(choice, plan, None if chosen is None else chosen(choice))


def problems_of(error: NotFast, tree: Node | None, file: Path) -> list[Problem]:
    """Each with its place in the scenario, where it has one."""
    return [one for refusal in error.refusals for one in _problems(refusal, tree, file)]


def tree_of(loaded: Any) -> Node | None:
    """What stands in the file of a variant, ``like`` filled in; None where the file is not there or is another now."""
    from opsim.scenario.read import variant_trees

    try:
        name, trees, _ = variant_trees(loaded.file, loaded.variant)
    except (ScenarioError, OSError):
        return None
    return without_likes(trees[name])[0]


def _problems(refusal: Refusal, tree: Node | None, file: Path) -> Iterable[Problem]:
    """One at each place that says so; else one of the whole file."""
    message = f"the fast engine does not run this: {refusal.words}"
    nodes = {path: node for path in refusal.places if _says(node := child(tree, *path), refusal)}
    said = [problem(node.place, path, message, HINT) for path, node in nodes.items() if node is not None]
    return said or [Problem(str(file), 0, 0, "", message, HINT)]


def _says(node: Node | None, refusal: Refusal) -> bool:
    return node is not None and isinstance(node.value, str) and repr(node.value) in refusal.words
