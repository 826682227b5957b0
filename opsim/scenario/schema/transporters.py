"""Transporters: vehicles that fetch jobs and bring them on."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from opsim.problems import shown
from opsim.scenario.fields import NameText, SecondsOrZero, Speed, Whole, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.layout import Way

MOST_VEHICLES = 1000


def _pair(value: object) -> object:
    if not isinstance(value, list) or len(value) != 2 or not all(isinstance(end, str) for end in value):
        raise plain_error(f"expected a leg as two stations, found {shown(value)}", "such as [drill, paint]")
    return tuple(value)


Leg = Annotated[tuple[str, str], BeforeValidator(_pair)]


class Transporter(Block):
    """Vehicles of one kind, such as forklifts: a job of a leg waits at its station until one of them has loaded it.

    A job asks for a vehicle when its place at the next station is sure. The oldest call is served first, by the free
    vehicle that is there soonest; it takes along what else waits at that place, oldest first, as far as it has room,
    brings everything to where it goes, the nearest place first, and is free again when it is empty.
    Vehicles do not meet on the road.
    """

    n: Whole = Field(1, ge=1, le=MOST_VEHICLES, description="how many vehicles", examples=[2])
    at: NameText = Field(description="the place where they stand at the start", examples=["dock"])
    speed_m_per_s: Speed = Field(alias="speed", description="how fast they drive", examples=["2 m/s"])
    capacity: Whole = Field(1, ge=1, le=100_000, description="jobs that a vehicle carries at once", examples=[4])
    load_s: SecondsOrZero = Field(0.0, alias="load", description="time to load a job", examples=["10 s"])
    unload_s: SecondsOrZero = Field(0.0, alias="unload", description="time to unload a job", examples=["10 s"])
    legs: list[Leg] = Field(
        min_length=1,
        description="from which station to which they bring jobs; stores and conveyors count as stations",
        examples=["[[drill, paint], [paint, pack]]"],
    )
    roads: list[Way] | None = Field(
        None,
        min_length=1,
        description="the only ways they take: places in a row, or one road with its length or direction; absent: they "
        "go as people do",
        examples=["[[dock, door, paint], {from: paint, to: dock, one_way: true}]"],
    )
    idle: Literal["stay", "home"] = Field(
        "stay", description="what an empty vehicle does that nobody calls: stay where it is, or drive back to 'at'"
    )
