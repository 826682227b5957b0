"""What may go wrong in a scenario that is right: said by ``opsim check`` as a warning, never refused."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise, product

from opsim.graph import rings
from opsim.names import natural_key
from opsim.scenario.schema import Scenario


def risks_of(scenario: Scenario) -> list[str]:
    """Every warning in a sentence."""
    return [*_locks(scenario), *_unused_patrols(scenario), *_unused_paths(scenario)]


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
        who = f"{names[0]} sends" if len(names) == 1 else f"{_and(names)} send"
        back = "back to itself" if len(names) == 1 else "round in a circle"
        yield (
            f"{who} jobs {back} through buffers with limits: when all are full, nothing moves any more; "
            f"give one of them 'buffer: unlimited'"
        )


def _ways(scenario: Scenario) -> dict[str, set[str]]:
    """Where jobs may go from each station."""
    ways: dict[str, set[str]] = {}
    for made in scenario.products.values():
        for here, there in pairwise(made.route or ()):
            for a, b in product(_one_of(here), _one_of(there)):
                ways.setdefault(a, set()).add(b)
        for here, onward in (made.routing or {}).items():
            ways.setdefault(here, set()).update(onward)
    return ways


def _one_of(step: str | list[str]) -> list[str]:
    return [step] if isinstance(step, str) else step


def _and(names: list[str]) -> str:
    listed = names if len(names) <= 6 else [*names[:5], f"{len(names) - 5} more"]
    return f"{', '.join(listed[:-1])} and {listed[-1]}"
