"""Conveyors: how long a job rides, how soon the next one may follow, how many are on it."""

from dataclasses import dataclass
from math import ceil, hypot

from opsim.clock import on_grid
from opsim.names import natural_key
from opsim.plan.ranks import Ranks


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


def plan_conveyors(scenario, ranks: Ranks) -> tuple[ConveyorPlan, ...]:
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
