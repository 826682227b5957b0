"""Scores that will be intervals, and rules by exposure where nobody has a body."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.kpi.better import read_asked
from opsim.kpi.names import ENERGY, LIFTED, SCORED
from opsim.names import natural_key
from opsim.plan.evenness import LEAST_EXPOSED
from opsim.plan.unsaid import LOAD, NO_LOAD, unsaid
from opsim.scenario.risks.words import listed
from opsim.scenario.schema import Scenario

BODIES = ("emulator", "motions", "plugin")
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
        yield f"{listed(names)}: no load is said: {NO_LOAD}; write 'load: 0 kg' where nothing heavy is held"


def _no_bodies(scenario: Scenario) -> Iterator[str]:
    if tasks_with_bodies(scenario):
        return
    rules = {"allocation.rule": scenario.allocation.rule}
    rules |= {f"rotations.{name}.rule": made.rule for name, made in scenario.rotations.items()}
    for path, rule in rules.items():
        if rule == LEAST_EXPOSED:
            yield f"{path}: {LEAST_EXPOSED} goes by postures, and no task has a body: everybody is as little exposed"
