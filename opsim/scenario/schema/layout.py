"""Where things are, and how a way between two places is measured."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from opsim.problems import shown
from opsim.scenario.fields import Length, Name, NameText, PathLength, plain_error
from opsim.scenario.schema.base import Block


def _two_lengths(value: object) -> object:
    if not isinstance(value, list) or len(value) != 2:
        raise plain_error(f"expected a place as two lengths, found {shown(value)}", "such as [4 m, 1 m]")
    return tuple(value)


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
    places: dict[Name, Annotated[tuple[Length, Length], BeforeValidator(_two_lengths)]] = Field(
        description="x and y of each place; with paths, doors and crossings too", examples=["{bench: [4 m, 1 m]}"]
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

    @property
    def path_steps(self) -> list[Path]:
        """Every path between two neighbours."""
        return steps_of(self.paths or ())
