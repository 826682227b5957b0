"""What a study varies: dotted paths, each with a list of values or a range."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag, model_validator

from opsim.problems import shown
from opsim.scenario.fields import Whole, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.studies.between import NotARange, check_range


class Range(Block):
    """From one value to another of the same unit, both ends included."""

    low: Any = Field(alias="from", description="the least value, with its unit", examples=["40 s"])
    high: Any = Field(alias="to", description="the largest value, with its unit", examples=["60 s"])
    levels: Whole | None = Field(
        None, ge=2, le=1000, description="of a grid: so many values, both ends among them", examples=[3]
    )

    @model_validator(mode="after")
    def _is_a_range(self) -> Range:
        try:
            check_range(self.low, self.high)
        except NotARange as error:
            raise plain_error(error.message, error.hint) from None
        return self


def _refuse_twice(values: list[Any]) -> None:
    """A value that stands twice would count for two."""
    seen: set[str] = set()
    for number, value in enumerate(values):
        written = repr(value)
        if written in seen:
            raise plain_error(f"{shown(value)} stands twice among the values", "give each value once", on=number)
        seen.add(written)


def _list_or_range(value: object) -> object:
    if isinstance(value, list) and value:
        _refuse_twice(value)
        return value
    if isinstance(value, dict | Range):
        return value
    hint = "such as [40 s, 50 s] or {from: 40 s, to: 60 s}"
    raise plain_error(f"expected values or a range, found {shown(value)}", hint)


def _tag(value: object) -> str:
    return "<values>" if isinstance(value, list) else "<range>"


Factor = Annotated[
    Annotated[Range, Tag("<range>")] | Annotated[list[Any], Tag("<values>")],
    Discriminator(_tag),
    BeforeValidator(_list_or_range),
]
Factors = Annotated[
    dict[str, Factor],
    Field(
        min_length=1,
        description="dotted path of the scenario: values, or a range {from: 40 s, to: 60 s}",
        examples=["{stations.saw.buffer: [1, 2, 4], release.every: {from: 40 s, to: 60 s}}"],
    ),
]
