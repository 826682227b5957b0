"""What a scenario may say of conveyors, and what that is in numbers: rides, distances, how many are on one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil, hypot
from typing import TYPE_CHECKING

from pydantic import Field, model_validator

from opsim.clock import on_grid
from opsim.problems import natural_key
from opsim.scenario.fields import BeltSpeed, NameText, Pitch, plain_error
from opsim.scenario.tree import Block

if TYPE_CHECKING:
    from opsim.scenario.schema.layout import Layout


class Conveyor(Block):
    """A belt, used as a step of a route: a job rides it from end to end in length / speed, in the order it got on.

    Jobs are at least ``pitch`` apart, so one gets on every pitch / speed at most, and length / pitch of them (rounded
    up) are on it at once. A job at the end stays there until its next step has room.
    """

    start: NameText = Field(alias="from", description="the place where jobs get on", examples=["press"])
    end: NameText = Field(alias="to", description="the place where jobs get off", examples=["pack"])
    speed_m_per_s: BeltSpeed = Field(alias="speed", description="how fast it moves", examples=["0.2 m/s"])
    pitch_m: Pitch = Field(
        alias="pitch", description="room that a job takes, its gap to the next included", examples=["0.5 m"]
    )
    length_m: Pitch | None = Field(
        None, alias="length", description="else that of the straight line between its ends", examples=["6 m"]
    )
    accumulating: bool = Field(
        True,
        description="true: jobs close up behind one that waits at the end; false: then the whole belt stands still",
    )

    @model_validator(mode="after")
    def _room_for_one(self) -> Conveyor:
        if self.length_m is not None and self.length_m < self.pitch_m:
            found = f"a belt of {self.length_m:g} m has no room for a job of {self.pitch_m:g} m"
            raise plain_error(found, "make the belt longer or the pitch smaller", on="length")
        return self


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


def plan_conveyors(
    said: Mapping[str, Conveyor], layout: Layout, points: Mapping[str, int], places: Mapping[str, int]
) -> tuple[ConveyorPlan, ...]:
    """Conveyors in natural order; points, places : their ranks."""
    return tuple(
        ConveyorPlan(
            points[name],
            places[belt.end],
            on_grid(length_m(belt, layout) / belt.speed_m_per_s),
            on_grid(belt.pitch_m / belt.speed_m_per_s),
            belt_capacity(belt, layout),
            belt.accumulating,
        )
        for name, belt in sorted(said.items(), key=lambda item: natural_key(item[0]))
    )


def length_m(belt: Conveyor, layout: Layout) -> float:
    """What is said, or the straight line between the ends of a belt."""
    if belt.length_m is not None:
        return belt.length_m
    (x, y), (u, v) = layout.places[belt.start], layout.places[belt.end]
    return hypot(x - u, y - v)


def belt_capacity(belt: Conveyor, layout: Layout) -> int:
    """Jobs on a belt at once: one each pitch, the last of which may stick out at the beginning."""
    return max(1, ceil(length_m(belt, layout) / belt.pitch_m - 1e-9))
