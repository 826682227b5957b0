"""The engine of each variant of a scenario; what the fast one does not run is said with its place, all at once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from opsim.engine.choice import AUTO, FAST, Choice, NotFast, Refusal, Told, able_to, make_ready, simpy_s, worth
from opsim.plan import Plan
from opsim.problems import Problem, ScenarioError
from opsim.scenario.like import without_likes
from opsim.scenario.positions import Node, child, problem
from opsim.study.pool import cores

Chosen = Callable[[Choice], Told | None]
"""Is told which engine is used; what it gives back, if anything, is told how far the compiling is."""
HINT = "--engine simpy runs it, and --engine auto finds that out by itself"


def engine_of(asked: str | Choice, loaded: Any, plan: Plan, runs: int = 1, *, processes: int | None = None) -> Choice:
    """The engine of one variant; a Choice stays what it is. Raises ScenarioError, ValueError for an unknown word."""
    if isinstance(asked, Choice):
        return asked
    return engines_of(asked, {"": (loaded, plan)}, {"": runs}, processes=processes)[""]


def engines_of(
    asked: str,
    variants: Mapping[str, tuple[Any, Plan]],
    runs: Mapping[str, int],
    *,
    processes: int | None = None,
    hint: str = HINT,
) -> dict[str, Choice]:
    """The engine of each variant, (as read, its Plan) by name; runs : replications of each that are to be made

    Raises ScenarioError with everything in them that the fast engine does not run, where it is asked for; hint : the
    way out.
    """
    able, wrong = dict[str, Choice](), list[Problem]()
    for name, (loaded, plan) in variants.items():
        try:
            able[name] = able_to(asked, plan)
        except NotFast as error:
            wrong += problems_of(error, tree_of(loaded), loaded.file, hint)
    if wrong:
        raise ScenarioError(dict.fromkeys(wrong))
    if asked != AUTO:
        return able
    fast = [name for name, choice in able.items() if choice.engine == FAST]
    waited_s = sum(_simpy_clock_s(variants[name][1], runs[name], processes) for name in fast)
    of = f" for {len(fast)} variants" if len(fast) > 1 else ""
    return {name: worth(choice, variants[name][1], waited_s, of=of) for name, choice in able.items()}


def _simpy_clock_s(plan: Plan, runs: int, processes: int | None) -> float:
    """Seconds of so many replications by SimPy, on all cores that they may use."""
    return simpy_s(plan) * runs / max(1, min(runs, processes or cores()))


def compiled_for(choice: Choice, plan: Plan, chosen: Chosen | None) -> None:
    """Tell of a choice, and make it ready for a Plan."""
    make_ready(choice, plan, None if chosen is None else chosen(choice))


def problems_of(error: NotFast, tree: Node | None, file: Path, hint: str = HINT) -> list[Problem]:
    """Each with its place in the scenario, where it has one."""
    return [one for refusal in error.refusals for one in _problems(refusal, tree, file, hint)]


def tree_of(loaded: Any) -> Node | None:
    """What stands in the file of a variant, ``like`` filled in; None where the file is not there or is another now."""
    from opsim.scenario.read import variant_trees

    try:
        name, trees, _ = variant_trees(loaded.file, loaded.variant)
    except (ScenarioError, OSError):
        return None
    return without_likes(trees[name])[0]


def _problems(refusal: Refusal, tree: Node | None, file: Path, hint: str) -> Iterable[Problem]:
    """One at each place that says so; else one of the whole file."""
    message = f"the fast engine does not run this: {refusal.words}"
    nodes = {path: node for path in refusal.places if _says(node := child(tree, *path), refusal)}
    said = [problem(node.place, path, message, hint) for path, node in nodes.items() if node is not None]
    return said or [Problem(str(file), 0, 0, "", message, hint)]


def _says(node: Node | None, refusal: Refusal) -> bool:
    return node is not None and isinstance(node.value, str) and repr(node.value) in refusal.words
