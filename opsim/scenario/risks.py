"""What may go wrong in a scenario that is right: said by ``opsim check`` as a warning, never refused."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, product

from opsim.graph import reverse, rings
from opsim.kpi.names import POSTURE, WALKING
from opsim.names import natural_key
from opsim.scenario.schema import Scenario


def risks_of(scenario: Scenario) -> list[str]:
    """Every warning in a sentence."""
    parts = (_locks, _held, _unused_patrols, _unused_paths, _no_bodies, _no_walking)
    return [risk for part in parts for risk in part(scenario)]


def _no_bodies(scenario: Scenario) -> Iterator[str]:
    """Postures are asked for, and every task is a time without a body; what a plug-in gives is not known here."""
    asked = [name for name in scenario.outputs if name in POSTURE and name not in WALKING]
    kinds = ("emulator", "motions", "plugin")
    may_have = [task for task in scenario.tasks.values() if any(hasattr(task, kind) for kind in kinds)]
    if asked and not may_have and scenario.walking is None:
        yield f"outputs: {_and(asked)} made from postures, and no task has an emulator: nothing will be measured"


def _no_walking(scenario: Scenario) -> Iterator[str]:
    """Figures of walking are asked for, and nothing says how people walk."""
    asked = [name for name in scenario.outputs if name in WALKING]
    if asked and scenario.walking is None:
        yield (
            f"outputs: {_and(asked)} made from postures of walking, and nothing says how people walk: add 'libraries: "
            "{walking: libraries/walking.npz}' and 'walking: {emulator: walking/walk}'"
        )


def _unused_paths(scenario: Scenario) -> Iterator[str]:
    if scenario.layout.paths is not None and scenario.layout.distance != "paths":
        yield f"the paths of the layout mean nothing with distance: {scenario.layout.distance}"


def _unused_patrols(scenario: Scenario) -> Iterator[str]:
    walkers = [name for name, worker in scenario.workers.items() if worker.patrol is not None]
    if walkers and scenario.allocation.idle != "patrol":
        who = f"{walkers[0]} has a patrol" if len(walkers) == 1 else f"{_and(walkers)} have patrols"
        yield f"{who}, which means nothing while idle workers {scenario.allocation.idle}"


def _locks(scenario: Scenario) -> Iterator[str]:
    """Stations that pass jobs round, each with a finite buffer: all may be full, and each wait for the next."""
    ways = _ways(scenario)
    finite = {name for name, station in scenario.stations.items() if station.buffer is not None}
    onward = {name: ways.get(name, set()) & finite for name in finite}
    for names in sorted(sorted(ring, key=natural_key) for ring in rings(onward)):
        if len(names) > 1:  # a job that comes back to its own station keeps its place there
            yield (
                f"{_and(names)} send jobs round in a circle through buffers with limits: when all are full, nothing "
                f"moves any more; give one of them 'buffer: unlimited'"
            )


def _held(scenario: Scenario) -> Iterator[str]:
    """Workers who stay with a blocked job, all of them, in front of a full station that waits for one of them."""
    held = scenario.allocation.when_blocked == "held"
    why, remedy = ("when_blocked: held", "'when_blocked: free'") if held else ("carried: true", "'carried: false'")
    workers, back = _workers(scenario), reverse(_ways(scenario, only_carried=not held))
    for name in sorted(workers, key=natural_key):
        people = workers[name]
        feeders = [other for other in back.get(name, ()) if other in workers]
        free = people.difference(*(workers[other] for other in feeders))
        n_held = sum(scenario.stations[other].servers for other in feeders)
        if scenario.stations[name].buffer is not None and not free and n_held >= len(people):
            who = _and(sorted(people, key=natural_key))
            before = _and(sorted(feeders, key=natural_key))
            yield (
                f"with {why}, {who} can all be held at {before} while {name} is full and waits for one of "
                f"them: then nothing moves any more; take {remedy}, or let somebody work at {name} alone"
            )


def _workers(scenario: Scenario) -> dict[str, set[str]]:
    """Who can work at each station; no station where everything is automatic, or nobody can."""
    by_hand = {task for task, block in scenario.tasks.items() if not block.automatic}
    manned = {name for name, station in scenario.stations.items() if not by_hand.isdisjoint(station.tasks)}
    able: dict[str, set[str]] = {}
    for name, worker in scenario.workers.items():
        for station in manned.intersection(worker.skills):
            able.setdefault(station, set()).add(name)
    return able


def _ways(scenario: Scenario, only_carried: bool = False) -> dict[str, set[str]]:
    """Where jobs may go from each station."""
    ways: dict[str, set[str]] = {}
    for made in (made for made in scenario.products.values() if made.carried or not only_carried):
        for here, there in pairwise(made.route or ()):
            for a, b in product(_one_of(here), _one_of(there)):
                ways.setdefault(a, set()).add(b)
        for here, onward in (made.routing or {}).items():
            ways.setdefault(here, set()).update(onward)
    return ways


def _one_of(step: str | list[str]) -> list[str]:
    return [step] if isinstance(step, str) else step


def _and(names: list[str]) -> str:
    if len(names) == 1:
        return names[0]
    listed = names if len(names) <= 6 else [*names[:5], f"{len(names) - 5} more"]
    return f"{', '.join(listed[:-1])} and {listed[-1]}"
