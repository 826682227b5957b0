"""Tools and fixtures: shared by stations and tasks, held for a visit, for a task, or between two moments of it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from opsim.problems import shown
from opsim.scenario.fields import NameText, Whole, plain_error
from opsim.scenario.tree import Block

ATTENDED = "attended"


class Tool(Block):
    """Tools or fixtures of one kind."""

    n: Whole = Field(1, ge=1, le=100_000, description="how many there are", examples=[2])


def _mark(value: object) -> object:
    """The name of a mark, or a share of the performance."""
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        raise plain_error(f"expected a mark or a share, found {shown(value)}", "such as grasp, or 0.25")
    if isinstance(value, str):
        return value
    if not 0 <= value <= 1:
        raise plain_error(
            f"a share of the performance lies between 0 and 1, found {shown(value)}", "such as 0.25, or a mark"
        )
    return float(value)


Mark = Annotated[
    str | float,
    BeforeValidator(_mark),
    WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "number", "minimum": 0, "maximum": 1}]}),
]
Needs = Annotated[
    dict[str, Annotated[Whole, Field(ge=1, le=100_000)]],
    Field(description="so many of each tool", examples=["{fixture: 1}"]),
]


class Moments(Block):
    """From one moment of a performance to another."""

    start: Mark = Field(
        0.0, alias="from", description="a mark of the movement, or a share of the performance", examples=["grasp", 0.25]
    )
    end: Mark = Field(
        1.0, alias="to", description="a mark of the movement, or a share of the performance", examples=["release", 0.75]
    )

    @model_validator(mode="after")
    def _some_time(self) -> Moments:
        if self.start == self.end or (
            isinstance(self.start, float) and isinstance(self.end, float) and self.start > self.end
        ):
            hint = (
                "write a later mark or share" if self.start == self.end else f"write from: {self.end}, to: {self.start}"
            )
            raise plain_error(f"from ({self.start}) must come before to ({self.end})", hint, on="to")
        return self


class Hold(Moments):
    """A tool in the hands from one moment of a performance to another; who finds none free waits at that moment."""

    tool: NameText = Field(description="one of the tools", examples=["torque_gun"])


def _automatic(value: object) -> object:
    if isinstance(value, bool) or value == ATTENDED:
        return value
    raise plain_error(f"expected true, false or {ATTENDED}, found {shown(value)}", f"such as {ATTENDED}")


Automatic = Annotated[bool | Literal["attended"], BeforeValidator(_automatic)]
