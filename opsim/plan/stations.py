"""Points of the flow: stations with servers and room in front of them; stores and conveyors stand in the same list.

Conveyors: how long a job rides, how soon the next one may follow, how many are on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, hypot, inf
from typing import TYPE_CHECKING

from opsim.clock import on_grid
from opsim.plan.calendar import OPEN, open_times
from opsim.plan.lines import buffer_of
from opsim.plan.tasks import Needs, Ranks, needs_of
from opsim.problems import natural_key

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


@dataclass(frozen=True, slots=True)
class ConveyorPlan:
    """station : its rank among the points of the flow; place_to : where jobs get off

    travel_s  : from end to end without a stop
    headway_s : from one job getting on to the next
    capacity  : jobs that are on it at once
    """

    station: int
    place_to: int
    travel_s: float
    headway_s: float
    capacity: int
    accumulating: bool


def plan_conveyors(scenario: Scenario, ranks: Ranks) -> tuple[ConveyorPlan, ...]:
    """Conveyors in natural order."""
    return tuple(
        ConveyorPlan(
            ranks.stations[name],
            ranks.places[belt.end],
            on_grid(length_m(belt, scenario.layout) / belt.speed_m_per_s),
            on_grid(belt.pitch_m / belt.speed_m_per_s),
            belt_capacity(belt, scenario.layout),
            belt.accumulating,
        )
        for name, belt in sorted(scenario.conveyors.items(), key=lambda item: natural_key(item[0]))
    )


def length_m(belt, layout) -> float:
    """What is said, or the straight line between the ends of a belt."""
    if belt.length_m is not None:
        return belt.length_m
    (x, y), (u, v) = layout.places[belt.start], layout.places[belt.end]
    return hypot(x - u, y - v)


def belt_capacity(belt, layout) -> int:
    """Jobs on a belt at once: one each pitch, the last of which may stick out at the beginning."""
    return max(1, ceil(length_m(belt, layout) / belt.pitch_m - 1e-9))


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
