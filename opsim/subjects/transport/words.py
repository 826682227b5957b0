"""Where things are, and how a way between two places is measured.

Transporters: vehicles that fetch jobs and bring them on.

Conveyors: belts and roller tracks that take jobs from one place to another.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from opsim.problems import shown
from opsim.scenario.fields import (
    BeltSpeed,
    Depth,
    Elevation,
    Length,
    Name,
    NameText,
    PathLength,
    Pitch,
    SecondsOrZero,
    Speed,
    Whole,
    plain_error,
)
from opsim.scenario.tree import Block


def _two_lengths(value: object) -> object:
    if not isinstance(value, list) or len(value) != 2:
        raise plain_error(f"expected a place as two lengths, found {shown(value)}", "such as [4 m, 1 m]")
    return tuple(value)


At = Annotated[tuple[Length, Length], BeforeValidator(_two_lengths)]
SURFACE = "surface"


class Place(Block):
    """A place with heights above the floor, such as the shelves of a rack or the top of a bench, for hands to go to."""

    at: At = Field(description="x and y", examples=["[9 m, 1 m]"])
    levels_m: dict[Name, Elevation] = Field(
        {},
        alias="levels",
        description="heights above the floor, by name",
        examples=["{low: 0.3 m, hip: 0.95 m, top: 1.6 m}"],
    )
    surface_m: Elevation | None = Field(
        None, alias="surface", description="height of what one works on, a level called surface", examples=["0.95 m"]
    )
    depth_m: Depth | None = Field(
        None,
        alias="depth",
        description="how far before the ankles hands go there; absent: as far as in the recordings",
        examples=["0.4 m"],
    )

    @model_validator(mode="after")
    def _one_surface(self) -> Place:
        if self.surface_m is not None and SURFACE in self.levels_m:
            raise plain_error("two heights are called surface", "give the level another name", on=SURFACE)
        return self

    @property
    def heights_m(self) -> dict[str, float]:
        """Metres above the floor by name, the surface among them."""
        return self.levels_m if self.surface_m is None else {**self.levels_m, SURFACE: self.surface_m}


def _point_or_block(value: object) -> object:
    return value if isinstance(value, dict) else _two_lengths(value)


PlaceOrPoint = Annotated[
    Annotated[tuple[Length, Length], Tag("<at>")] | Annotated[Place, Tag("<place>")],
    Discriminator(lambda value: "<place>" if isinstance(value, dict | Place) else "<at>"),
    BeforeValidator(_point_or_block),
]


class Path(Block):
    """A path between two places, with what a list of places cannot say."""

    start: NameText = Field(alias="from", description="a place of the layout", examples=["door"])
    end: NameText = Field(alias="to", description="a place of the layout", examples=["bench"])
    one_way: bool = Field(False, description="true: only from 'from' to 'to'")
    length_m: PathLength | None = Field(
        None, alias="length", description="else that of the straight line", examples=["12 m"]
    )


def _list_or_block(value: object) -> object:
    if not isinstance(value, list | dict) or (isinstance(value, list) and len(value) < 2):
        hint = "such as [door, crossing, bench] or {from: door, to: bench, one_way: true}"
        raise plain_error(f"expected a path, found {shown(value)}", hint)
    return value


def _path_tag(value: Any) -> str:
    return "<places>" if isinstance(value, list) else "<path>"


Way = Annotated[
    Annotated[list[NameText], Tag("<places>")] | Annotated[Path, Tag("<path>")],
    Discriminator(_path_tag),
    BeforeValidator(_list_or_block),
]


def steps_of(ways: Iterable[list[str] | Path]) -> list[Path]:
    """Every path between two neighbours; a list of places is one for each pair that follow each other."""
    steps: list[Path] = []
    for way in ways:
        if isinstance(way, Path):
            steps.append(way)
        else:
            steps += [Path.model_validate({"from": a, "to": b}) for a, b in pairwise(way)]
    return steps


class Layout(Block):
    """Where things are, and how a way between two places is measured."""

    distance: Literal["euclidean", "rectilinear", "paths"] = Field(
        "rectilinear", description="how far it is: straight (euclidean), along the axes (rectilinear), along the paths"
    )
    stands: dict[Name, PlaceOrPoint] = Field(
        alias="places",
        description="x and y of each place, heights where hands need them; with paths, doors and crossings too",
        examples=["{bench: [4 m, 1 m], rack: {at: [9 m, 1 m], levels: {low: 0.3 m, top: 1.6 m}}}"],
    )
    paths: list[Way] | None = Field(
        None,
        min_length=1,
        description="where one can walk: places in a row, or one path with its length or direction",
        examples=["[[door, crossing, bench], {from: bench, to: rack, length: 12 m}]"],
    )

    @model_validator(mode="after")
    def _paths_where_they_mean_something(self) -> Layout:
        if self.distance == "paths" and self.paths is None:
            raise plain_error("distance: paths needs to know where one can walk", "add e.g. 'paths: [[door, bench]]'")
        if self.paths is not None and "distance" not in self.model_fields_set:
            raise plain_error("paths are followed only with distance: paths", "add 'distance: paths'", on="paths")
        return self

    @cached_property
    def places(self) -> dict[str, tuple[float, float]]:
        """x and y of every place, in metres."""
        return {name: one.at if isinstance(one, Place) else one for name, one in self.stands.items()}

    @property
    def with_heights(self) -> dict[str, Place]:
        """The places that have heights, by name."""
        return {name: one for name, one in self.stands.items() if isinstance(one, Place)}

    @property
    def path_steps(self) -> list[Path]:
        """Every path between two neighbours."""
        return steps_of(self.paths or ())


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
