"""Rules and subjects of a Plan that are plug-ins: Python objects, which only the reference engine can call."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from opsim.plan import Plan

DISPATCH, SEQUENCING = "opsim.dispatch", "opsim.sequencing"
ROUTING, ROTATION = "opsim.routing", "opsim.rotation"
SUBJECTS = "opsim.subjects"
Path = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PluginRule:
    """A rule or subject by group and name; places : paths of the scenario where it may stand, the likeliest first."""

    group: str
    name: str
    places: tuple[Path, ...]

    def __str__(self) -> str:
        what = "subject" if self.group == SUBJECTS else "rule"
        return f"the {what} {self.name!r} of {self.group} is a plug-in in Python"


def plugin_rules(plan: Plan) -> list[PluginRule]:
    """Every rule that is not one of ours, each place once; sequencing also where the floor's rule is meant; then
    the subjects, which are never ours."""
    from opsim.plugins.registry import RULES

    rules = [rule for rule in dict.fromkeys(_rules(plan)) if rule.name not in RULES[rule.group]]
    stations = [station.name for station in plan.stations]
    for one in plan.subjects:
        rules.append(PluginRule(SUBJECTS, one.key, (*(("stations", n, one.key) for n in stations), (one.key,))))
    return rules


def _rules(plan: Plan) -> Iterator[PluginRule]:
    yield PluginRule(DISPATCH, plan.rule, (("allocation", "rule"),))
    yield PluginRule(ROUTING, plan.routing, (("flow", "routing"),))
    for queue in plan.queues:
        own = ("stations", plan.stations[queue.station].name, "dispatch")
        yield PluginRule(SEQUENCING, queue.rule, (own, ("flow", "dispatch")))
    for rotation in plan.rotations:
        yield PluginRule(ROTATION, rotation.rule, (("rotations", rotation.name, "rule"),))
