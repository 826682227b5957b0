"""What is said and means nothing: figures without postures, patrols and paths without use, points nobody comes by."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.kpi.names import EXPOSURE, POSTURE, WALKING
from opsim.names import natural_key
from opsim.scenario.risks.ways import points_of, ways
from opsim.scenario.risks.words import listed
from opsim.scenario.schema import Scenario


def unused_risks(scenario: Scenario) -> Iterator[str]:
    """Every key that changes nothing."""
    for part in (_points, _resources, _legs, _patrols, _paths, _no_bodies, _no_walking):
        yield from part(scenario)


def _points(scenario: Scenario) -> Iterator[str]:
    """Stations, stores and conveyors that no product comes by."""
    come_by = {name for made in scenario.products.values() for name in points_of(made)}
    come_by |= {s.inspect.rework for s in scenario.stations.values() if s.inspect is not None and s.inspect.rework}
    sections = (scenario.stations, scenario.stores, scenario.conveyors)
    idle = sorted({name for section in sections for name in section} - come_by, key=natural_key)
    if idle:
        yield f"no product comes to {listed(idle)}: nothing will happen there"


def _resources(scenario: Scenario) -> Iterator[str]:
    """Tools and repair teams that nobody asks for."""
    tools = {name for block in (*scenario.stations.values(), *scenario.tasks.values()) for name in block.needs}
    tools |= {task.hold.tool for task in scenario.tasks.values() if task.hold is not None}
    teams = {stop.team for station in scenario.stations.values() for stop in station.breakdowns.values()}
    teams |= {stop.team for station in scenario.stations.values() for stop in station.maintenance.values()}
    for what, there, used in (
        ("tool", scenario.tools, tools),
        ("repair team", scenario.repair_teams, teams),
    ):
        idle = sorted(set(there) - used, key=natural_key)
        if idle:
            yield f"{what} {listed(idle)}: nothing needs {'it' if len(idle) == 1 else 'them'}"


def _legs(scenario: Scenario) -> Iterator[str]:
    """Legs of transporters that no job goes: a job from outside, or taken from a store, is not brought."""
    onward = ways(scenario)
    for name in sorted(scenario.transporters, key=natural_key):
        legs = scenario.transporters[name].legs
        idle = [f"from {before} to {after}" for before, after in legs if after not in onward.get(before, ())]
        if idle:
            yield f"no product goes {listed(idle)}: {name} has nothing to bring there"


def _patrols(scenario: Scenario) -> Iterator[str]:
    walkers = [name for name, worker in scenario.workers.items() if worker.patrol is not None]
    if walkers and scenario.allocation.idle != "patrol":
        who = f"{walkers[0]} has a patrol" if len(walkers) == 1 else f"{listed(walkers)} have patrols"
        yield f"{who}, which means nothing while idle workers {scenario.allocation.idle}"


def _paths(scenario: Scenario) -> Iterator[str]:
    if scenario.layout.paths is not None and scenario.layout.distance != "paths":
        yield f"the paths of the layout mean nothing with distance: {scenario.layout.distance}"


def _no_bodies(scenario: Scenario) -> Iterator[str]:
    """Postures are asked for, and every task is a time without a body; what a plug-in gives is not known here."""
    asked = [name for name in scenario.outputs if name in (*POSTURE, *EXPOSURE) and name not in WALKING]
    kinds = ("emulator", "motions", "plugin")
    may_have = [task for task in scenario.tasks.values() if any(hasattr(task, kind) for kind in kinds)]
    if asked and not may_have and scenario.walking is None:
        yield f"outputs: {listed(asked)} made from postures, and no task has an emulator: nothing will be measured"


def _no_walking(scenario: Scenario) -> Iterator[str]:
    """Figures of walking are asked for, and nothing says how people walk."""
    asked = [name for name in scenario.outputs if name in WALKING]
    if asked and scenario.walking is None:
        yield (
            f"outputs: {listed(asked)} made from postures of walking, and nothing says how people walk: add "
            "'libraries: {walking: libraries/walking.npz}' and 'walking: {emulator: walking/walk}'"
        )
