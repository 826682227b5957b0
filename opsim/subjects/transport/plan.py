"""Transporters: vehicles, the legs they serve, and their roads.

Conveyors: how long a job rides, how soon the next one may follow, how many are on it.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, hypot
from typing import TYPE_CHECKING

from opsim.clock import on_grid
from opsim.layout import Matrix, road_distances_m
from opsim.plan.ranks import Ranks
from opsim.problems import natural_key

if TYPE_CHECKING:
    from opsim.scenario.schema import Scenario


def length_m(belt, layout) -> float:
    """What is said, or the straight line between the ends of a belt."""
    if belt.length_m is not None:
        return belt.length_m
    (x, y), (u, v) = layout.places[belt.start], layout.places[belt.end]
    return hypot(x - u, y - v)


def belt_capacity(belt, layout) -> int:
    """Jobs on a belt at once: one each pitch, the last of which may stick out at the beginning."""
    return max(1, ceil(length_m(belt, layout) / belt.pitch_m - 1e-9))


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


@dataclass(frozen=True, slots=True)
class LegPlan:
    """From a station to another, as ranks among the points of the flow; and the places of loading and unloading."""

    before: int
    after: int
    place_from: int
    place_to: int


@dataclass(frozen=True, slots=True)
class TransporterPlan:
    """Vehicles of one kind.

    n, capacity    : how many there are, and how many jobs one carries at once; place : where they stand at the start
    load_s, unload_s : for each job; 0 is nothing
    distance_m     : (P, P) metres between places on their roads, inf where none leads
    goes_home      : whether an empty vehicle that nobody calls drives back to its place
    """

    name: str
    n: int
    place: int
    speed_m_per_s: float
    capacity: int
    load_s: float
    unload_s: float
    legs: tuple[LegPlan, ...]
    distance_m: Matrix
    goes_home: bool = False

    def drive_s(self, start: int, end: int) -> float:
        """Seconds from one place to another."""
        return self.distance_m[start][end] / self.speed_m_per_s


def plan_transporters(scenario: Scenario, ranks: Ranks, distance_m: Matrix) -> tuple[TransporterPlan, ...]:
    """Transporters in natural order; ``distance_m`` are the ways of those without roads of their own."""
    return tuple(
        TransporterPlan(
            name,
            vehicle.n,
            ranks.places[vehicle.at],
            vehicle.speed_m_per_s,
            vehicle.capacity,
            vehicle.load_s,
            vehicle.unload_s,
            tuple(_leg(before, after, scenario, ranks) for before, after in sorted(vehicle.legs)),
            distance_m if vehicle.roads is None else road_distances_m(scenario.layout, vehicle.roads),
            vehicle.idle == "home",
        )
        for name, vehicle in sorted(scenario.transporters.items(), key=lambda item: natural_key(item[0]))
    )


def _leg(before: str, after: str, scenario: Scenario, ranks: Ranks) -> LegPlan:
    place_from, place_to = ranks.places[_place(before, scenario, "end")], ranks.places[_place(after, scenario, "start")]
    return LegPlan(ranks.stations[before], ranks.stations[after], place_from, place_to)


def _place(name: str, scenario: Scenario, end: str) -> str:
    """Where a point stands; of a conveyor the place of one of its ends."""
    if name in scenario.conveyors:
        return getattr(scenario.conveyors[name], end)
    return (scenario.stations if name in scenario.stations else scenario.stores)[name].at
