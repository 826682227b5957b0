"""Hands belong to tasks that have some, and figures of posture to runs in which somebody looks at postures.

What is risky: scores that will be intervals, and rules by exposure where nobody has a body.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from opsim.engine.rules import LEAST_EXPOSED
from opsim.kpi.catalogue import ENERGY, LIFTED, SCORED, needs_postures, read_asked
from opsim.problems import Problem, enumerated, natural_key
from opsim.scenario.schema import Scenario
from opsim.scenario.tree import Node, Part, child, entries, items, problem
from opsim.subjects.exposure.plan import LOAD, NO_LOAD, unsaid
from opsim.subjects.tasks.checks import moment_problems

HANDS = ("loaded", "handling")
Spot = tuple[str, int, int]


def ergonomic_problems(tree: Node, base: Node, folder: Path) -> Iterator[Problem]:
    """What is wrong with the hands of tasks, and with figures of posture.

    base : the file's own tree: what it says of all tasks under ``defaults`` may be of no use to some of them
    """
    usual = {_spot(node) for node in entries(base, "defaults", "tasks").values()}
    for name, task in entries(tree, "tasks").items():
        yield from _hands(name, task, usual)
        yield from moment_problems(tree, task, ("tasks", name, "loaded"), folder)
    yield from _figures(tree)


def _spot(node: Node) -> Spot:
    """Where a node was written. NOTE: a Place itself is slow to hash, with all lines of its file."""
    return node.place.source.file, node.place.line, node.place.column


def _hands(name: str, task: Node, usual: set[Spot]) -> Iterator[Problem]:
    """Hands where the station works alone; a time at which nothing is in them."""
    alone = child(task, "automatic")
    for key in HANDS:
        node = child(task, key)
        if node is None or _spot(node) in usual:
            continue
        if alone is not None and alone.value is True:
            found = "the station works alone: there are no hands"
            yield problem(node.name_place, ("tasks", name, key), found, f"remove {key!r}")
        elif key == "loaded" and child(task, "load") is None:
            found = "nothing says what is in the hands then"
            yield problem(node.name_place, ("tasks", name, key), found, "add e.g. 'load: 6 kg' to the task")


def _rules(tree: Node) -> Iterator[tuple[Part, ...]]:
    """Where rules stand that may go by exposure."""
    yield "allocation", "rule"
    for name in entries(tree, "rotations"):
        yield "rotations", name, "rule"


def _figures(tree: Node) -> Iterator[Problem]:
    """Figures and rules of posture where nobody looks at postures."""
    node = child(tree, "run", "posture")
    if node is None or node.value not in (False, "off"):
        return
    for path in _rules(tree):
        if (rule := child(tree, *path)) is not None and rule.value == LEAST_EXPOSED:
            found = "it goes by what postures do to bodies, and nobody looks at them ('posture: off')"
            yield problem(rule.place, path, found, "take another rule, or leave postures on")
    for key in ("outputs", "frontier"):
        for number, asked in enumerate(items(tree, key)):
            if isinstance(asked.value, str) and needs_postures([read_asked(asked.value).kpi]):
                found = "it is made from postures, and nobody looks at them ('posture: off')"
                yield problem(asked.place, (key, number), found, "remove one of the two lines")


"""Keys of tasks that may have a body."""
ASK_LOADS = {*SCORED, *LIFTED, *ENERGY}
"""Figures that ask what is in the hands."""


def exposure_risks(scenario: Scenario) -> Iterator[str]:
    """Loads that nobody says, and rules by exposure without bodies."""
    yield from _no_load(scenario)
    yield from _no_bodies(scenario)


def tasks_with_bodies(scenario: Scenario) -> list[str]:
    """Tasks that have, or with a plug-in may have, a body; in natural order."""
    tasks = scenario.tasks
    found = [name for name, task in tasks.items() if any(hasattr(task, kind) for kind in BODIES)]
    return sorted((name for name in found if tasks[name].automatic is not True), key=natural_key)


def _no_load(scenario: Scenario) -> Iterator[str]:
    asked = {*scenario.outputs, *(read_asked(figure).kpi for figure in scenario.frontier or ())}
    if asked.isdisjoint(ASK_LOADS):
        return
    tasks = [
        (name, scenario.tasks[name].load_kg, scenario.tasks[name].handling) for name in tasks_with_bodies(scenario)
    ]
    names = unsaid(tasks).get(LOAD, [])
    if names:
        yield f"{enumerated(names)}: no load is said: {NO_LOAD}; write 'load: 0 kg' where nothing heavy is held"


def _no_bodies(scenario: Scenario) -> Iterator[str]:
    if tasks_with_bodies(scenario):
        return
    rules = {"allocation.rule": scenario.allocation.rule}
    rules |= {f"rotations.{name}.rule": made.rule for name, made in scenario.rotations.items()}
    for path, rule in rules.items():
        if rule == LEAST_EXPOSED:
            yield f"{path}: {LEAST_EXPOSED} goes by postures, and no task has a body: everybody is as little exposed"


BODIES = ("emulator", "motions", "plugin")
