"""What a study varies: dotted paths, each with a list of values or a range."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from opsim.problems import shown
from opsim.scenario.fields import plain_error
from opsim.scenario.schema.base import Block


class Range(Block):
    """From one value to another of the same unit, both ends included."""

    low: Any = Field(alias="from", description="the least value, with its unit", examples=["40 s"])
    high: Any = Field(alias="to", description="the largest value, with its unit", examples=["60 s"])


def _list_or_range(value: object) -> object:
    if isinstance(value, list) and value:
        return value
    if isinstance(value, dict):
        return value
    hint = "such as [40 s, 50 s] or {from: 40 s, to: 60 s}"
    raise plain_error(f"expected values or a range, found {shown(value)}", hint)


Factor = Annotated[Range | list[Any], BeforeValidator(_list_or_range)]
Factors = Annotated[
    dict[str, Factor],
    Field(
        min_length=1,
        description="dotted path of the scenario: values, or a range {from: 40 s, to: 60 s}",
        examples=["{stations.saw.buffer: [1, 2, 4], release.every: {from: 40 s, to: 60 s}}"],
    ),
]
