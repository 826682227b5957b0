"""Products that are never made, never finished or pile up; keys that change nothing, of people and outputs too."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.kpi.catalogue import EXPOSURE, POSTURE, WALKING
from opsim.problems import enumerated, natural_key
from opsim.scenario.schema import Product, Release, Scenario
from opsim.scenario.warnings.routes import last_of, points_of, ways


def unfinished_risks(scenario: Scenario) -> Iterator[str]:
    """What no source makes, what waits for parts that do not come, what ends where nobody takes it."""
    made = _made(scenario)
    for name in sorted(scenario.products, key=natural_key):
        product = scenario.products[name]
        if made is not None and name not in made:
            yield f"{name} is never made: no source makes it, and nothing is split into it"
        for part, station in sorted((part, station) for station, parts in product.parts.items() for part in parts):
            if made is not None and part not in made and name in made:
                yield f"{name} cannot be finished: at {station} it waits for {part}, which is never made"
            yield from _too_many(name, station, part, product.parts[station][part], scenario)
        yield from _piles_up(name, product, scenario)


def _made(scenario: Scenario) -> set[str] | None:
    """The products that some source makes, or that something is split into; None where a file of orders says it."""
    sources = [scenario.release] if scenario.release is not None else list(scenario.sources.values())
    found: set[str] = set()
    for source in sources:
        some = _of_source(source, scenario)
        if some is None:
            return None
        found |= some
    todo = list(found)
    while todo:
        for pieces in scenario.products[todo.pop()].split.values():
            new = set(pieces) - found
            found |= new
            todo += new
    return found


def _of_source(source: Release, scenario: Scenario) -> set[str] | None:
    if source.products is not None:
        return set(source.products)
    if source.sequence is not None:
        return None if isinstance(source.sequence, str) else set(source.sequence)
    if source.kind == "base_stock":
        return {name for name, product in scenario.products.items() if source.store in last_of(product)}
    return None if source.kind == "schedule" else set(scenario.products)


def _too_many(name: str, station: str, part: str, pieces: int, scenario: Scenario) -> Iterator[str]:
    """More pieces at once than fit in the stores where they wait."""
    stores = [scenario.stores[point] for point in last_of(scenario.products[part]) if point in scenario.stores]
    room = sum(store.capacity or 0 for store in stores) * scenario.products[part].lot
    pieces *= scenario.products[name].lot
    if not stores or any(store.capacity is None for store in stores):
        return
    batch = scenario.stations[station].batch if station in scenario.stations else None
    if room < pieces:
        yield f"{name} cannot be finished: at {station} it takes {pieces} {part} at once, and {room} fit in store"
    elif batch is not None and room < pieces * batch.size:
        yield (
            f"{batch.size} {name} in one batch at {station} take {pieces * batch.size} {part} at once, and {room} fit "
            "in store: such a batch waits for ever; make room for more, or smaller batches"
        )


def _piles_up(name: str, product: Product, scenario: Scenario) -> Iterator[str]:
    """A product that ends in a store and is part of nothing stays there."""
    stores = [point for point in last_of(product) if point in scenario.stores]
    taken = any(name in parts for other in scenario.products.values() for parts in other.parts.values())
    if stores and not taken:
        yield f"{name} ends in {stores[0]}, from which nothing takes it: it piles up there and is never finished"


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
        yield f"no product comes to {enumerated(idle)}: nothing will happen there"


def _resources(scenario: Scenario) -> Iterator[str]:
    """Tools and repair teams that nobody asks for."""
    tools = {name for station in scenario.stations.values() for name in station.needs}
    tools |= {name for task in scenario.tasks.values() for name in task.needs}
    tools |= {task.hold.tool for task in scenario.tasks.values() if task.hold is not None}
    teams = {stop.team for station in scenario.stations.values() for stop in station.breakdowns.values()}
    teams |= {stop.team for station in scenario.stations.values() for stop in station.maintenance.values()}
    for what, there, used in (
        ("tool", scenario.tools, tools),
        ("repair team", scenario.repair_teams, teams),
    ):
        idle = sorted(set(there) - used, key=natural_key)
        if idle:
            yield f"{what} {enumerated(idle)}: nothing needs {'it' if len(idle) == 1 else 'them'}"


def _legs(scenario: Scenario) -> Iterator[str]:
    """Legs of transporters that no job goes: a job from outside, or taken from a store, is not brought."""
    onward = ways(scenario)
    for name in sorted(scenario.transporters, key=natural_key):
        legs = scenario.transporters[name].legs
        idle = [f"from {before} to {after}" for before, after in legs if after not in onward.get(before, ())]
        if idle:
            yield f"no product goes {enumerated(idle)}: {name} has nothing to bring there"


def _patrols(scenario: Scenario) -> Iterator[str]:
    walkers = [name for name, worker in scenario.workers.items() if worker.patrol is not None]
    if walkers and scenario.allocation.idle != "patrol":
        who = f"{walkers[0]} has a patrol" if len(walkers) == 1 else f"{enumerated(walkers)} have patrols"
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
        yield f"outputs: {enumerated(asked)} made from postures, and no task has an emulator: nothing will be measured"


def _no_walking(scenario: Scenario) -> Iterator[str]:
    """Figures of walking are asked for, and nothing says how people walk."""
    asked = [name for name in scenario.outputs if name in WALKING]
    if asked and scenario.walking is None:
        yield (
            f"outputs: {enumerated(asked)} made from postures of walking, and nothing says how people walk: add "
            "'libraries: {walking: libraries/walking.npz}' and 'walking: {emulator: walking/walk}'"
        )
