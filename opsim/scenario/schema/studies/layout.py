"""Which station stands where: what is asked."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, Field

from opsim.scenario.fields import Name, NameText, Whole, plain_error
from opsim.scenario.layout_moves import read_any_moved, read_moved
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.studies.figures import WayFigureText

MOST_PROPOSALS = 50
FEWEST_REPLICATIONS = 2
"""That say anything of a difference."""


def _one_or_more(value: object) -> object:
    return [value] if isinstance(value, str) else list(value) if isinstance(value, tuple) else value


def _readable(read: Callable[[str], object]) -> AfterValidator:
    """Each text is a change that can be read; which names there are is asked of the scenario later."""

    def check(texts: list[str]) -> list[str]:
        for number, text in enumerate(texts):
            try:
                read(text)
            except ValueError as error:
                message, _, hint = str(error).partition("; ")
                raise plain_error(message, hint, on=number) from None
        return texts

    return AfterValidator(check)


def _once(names: list[str]) -> list[str]:
    twice = [number for number, name in enumerate(names) if name in names[:number]]
    if twice:
        raise plain_error(f"{names[twice[0]]!r} is named twice", on=twice[0])
    return names


Names = Annotated[list[NameText], BeforeValidator(_one_or_more), AfterValidator(_once)]
AnyChange = Annotated[list[str], BeforeValidator(_one_or_more), Field(min_length=1), _readable(read_any_moved)]


class LayoutStudy(Block):
    """Which station stands where."""

    fixed: Names = Field([], description="stations that stay where they are", examples=["[saw, press]"])
    places: Names | None = Field(
        None,
        min_length=1,
        description="the only places where the other stations may be put; absent: where they stand now, and the places "
        "of the layout that nobody uses (with distance: paths only where stations stand now)",
        examples=["[bay_1, bay_2, bay_3]"],
    )
    proposals: Whole = Field(5, ge=0, le=MOST_PROPOSALS, description="how many are made and simulated", examples=[5])
    replications: Whole | None = Field(
        None,
        ge=FEWEST_REPLICATIONS,
        description="of each layout, and as many fresh ones of the one taken and of the present one; absent: those of "
        "run, but at least 10",
        examples=[20],
    )
    best: WayFigureText = Field(
        "throughput_per_h", description="by which figure the best is taken: a KPI, or 'less KPI'", examples=["walked_m"]
    )
    exposure: WayFigureText | None = Field(
        None,
        description="the second criterion: what bodies go through, of the worker who has most of it; absent: the first "
        "such figure among the outputs",
        examples=["rula_from_5_min_per_h"],
    )
    move: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("move", text))] = Field(
        [], description="what if a place were elsewhere", examples=["['bench=6 m, 1 m']"]
    )
    swap: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("swap", text))] = Field(
        [], description="what if two stations changed places", examples=["['saw,drill']"]
    )
    place: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("place", text))] = (
        Field([], description="what if a station stood at another place", examples=["['drill=spare_2']"])
    )
    add: Annotated[list[str], BeforeValidator(_one_or_more), _readable(lambda text: read_moved("add", text))] = Field(
        [], description="what if there were one more", examples=["['second_drill=like drill at spare_1']"]
    )
    what_ifs: dict[Name, AnyChange] = Field(
        {},
        description="layouts by name: changes, one after the other",
        examples=["{near: ['swap saw,drill', 'place pack=bay_7']}"],
    )
