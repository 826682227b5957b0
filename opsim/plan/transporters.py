"""Transporters: vehicles, the legs they serve, and their roads."""

from dataclasses import dataclass

from opsim.layout import Matrix, road_distances_m
from opsim.names import natural_key
from opsim.plan.ranks import Ranks


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


def plan_transporters(scenario, ranks: Ranks, distance_m: Matrix) -> tuple[TransporterPlan, ...]:
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


def _leg(before: str, after: str, scenario, ranks: Ranks) -> LegPlan:
    place_from, place_to = ranks.places[_place(before, scenario, "end")], ranks.places[_place(after, scenario, "start")]
    return LegPlan(ranks.stations[before], ranks.stations[after], place_from, place_to)


def _place(name: str, scenario, end: str) -> str:
    """Where a point stands; of a conveyor the place of one of its ends."""
    if name in scenario.conveyors:
        return getattr(scenario.conveyors[name], end)
    return (scenario.stations if name in scenario.stations else scenario.stores)[name].at
