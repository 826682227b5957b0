"""Points of the flow: stations with servers and room in front of them; stores and conveyors stand in the same list.

Batches: how many jobs go together, which, and how long the first of them waits.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING

from opsim.clock import on_grid
from opsim.plan.ranks import Ranks
from opsim.problems import natural_key
from opsim.subjects.lines.plan import buffer_of
from opsim.subjects.shifts.plan import OPEN, open_times
from opsim.subjects.tools.plan import Needs, needs_of
from opsim.subjects.transport.plan import belt_capacity

if TYPE_CHECKING:
    from opsim.scenario.schema import Batch, Scenario


STATION, STORE, CONVEYOR = "station", "store", "conveyor"


@dataclass(frozen=True, slots=True)
class StationPlan:
    """servers : jobs in process at once; buffer : places in front of the servers (inf where unlimited);
    tasks : ranks of the tasks a job gets here, in order; kind : ``station``, ``store`` or ``conveyor``;
    buffer_after : places for finished jobs, off the servers; place_first : a job is begun only when its place
    downstream is sure; needs : tools of a job from its server until it leaves.
    open_s : when it is open, None where always; at_close : what becomes then of what was begun
    priority : workers go to stations of a higher one first
    """

    name: str
    place: int
    servers: int
    buffer: float
    tasks: tuple[int, ...]
    kind: str = STATION
    buffer_after: int = 0
    place_first: bool = False
    needs: Needs = ()
    open_s: OPEN | None = None
    at_close: str = "finish"
    priority: int = 0

    @property
    def capacity(self) -> float:
        """Jobs that fit: on servers and in the buffer."""
        return self.servers + self.buffer


def plan_stations(scenario: Scenario, ranks: Ranks) -> tuple[StationPlan, ...]:
    """All points of the flow in natural order."""
    points = {name: _station(name, station, scenario, ranks) for name, station in scenario.stations.items()}
    points |= {name: _store(name, store, ranks) for name, store in scenario.stores.items()}
    points |= {name: _conveyor(name, belt, scenario, ranks) for name, belt in scenario.conveyors.items()}
    return tuple(points[name] for name in sorted(points, key=natural_key))


def _station(name: str, station, scenario: Scenario, ranks: Ranks) -> StationPlan:
    buffer = buffer_of(name, inf if station.buffer is None else station.buffer, scenario)
    tasks = tuple(ranks.tasks[task] for task in station.tasks)
    before = (station.blocking or scenario.flow.blocking) == "before"
    return StationPlan(
        *(name, ranks.places[station.at], station.servers, buffer, tasks),
        buffer_after=station.buffer_after,
        place_first=before,
        needs=needs_of(station, scenario),
        open_s=open_times(station.shift, scenario),
        at_close=station.at_close,
        priority=station.priority,
    )


def _store(name: str, store, ranks: Ranks) -> StationPlan:
    """A store has no servers, and room for what lies there."""
    capacity = inf if store.capacity is None else store.capacity
    return StationPlan(name, ranks.places[store.at], 0, capacity, (), STORE)


def _conveyor(name: str, belt, scenario: Scenario, ranks: Ranks) -> StationPlan:
    """A conveyor stands where jobs get on, and has room for those on it."""
    return StationPlan(name, ranks.places[belt.start], belt_capacity(belt, scenario.layout), 0, (), CONVEYOR)


@dataclass(frozen=True, slots=True)
class BatchPlan:
    """size : jobs on a server at once

    most_wait_s : after which a job goes with those there are, on the grid; inf for never
    class_of : (P,) jobs go together whose products have the same number
    """

    station: int
    size: int
    most_wait_s: float
    class_of: tuple[int, ...]


def plan_batches(scenario: Scenario, ranks: Ranks) -> tuple[BatchPlan, ...]:
    found = ((name, scenario.stations[name].batch) for name in sorted(scenario.stations, key=natural_key))
    return tuple(_batch(name, batch, scenario, ranks) for name, batch in found if batch is not None)


def _batch(name: str, batch: Batch, scenario: Scenario, ranks: Ranks) -> BatchPlan:
    classes = [_class(batch.of, product, scenario.products[product]) for product in ranks.products]
    number = {one: number for number, one in enumerate(dict.fromkeys(classes))}
    most_wait_s = inf if batch.most_wait_s is None else batch.most_wait_s and on_grid(batch.most_wait_s)
    return BatchPlan(ranks.stations[name], batch.size, most_wait_s, tuple(number[one] for one in classes))


def _class(of: str, name: str, product) -> str:
    """What goes together has the same word: all, a product, or a family (a product without one is by itself)."""
    if of == "family":
        return name if product.family is None else f"family: {product.family}"
    return name if of == "product" else ""
