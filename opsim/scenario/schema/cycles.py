"""Numbers of cycles between two breakdowns: always so many, or drawn."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, Tag, model_validator

from opsim.scenario.fields import Whole, plain_error
from opsim.scenario.schema.base import DIST, Block

MOST_CYCLES = 1_000_000_000


class GeometricCycles(Block):
    """The same chance, one in `mean`, after each cycle."""

    dist: Literal["geometric"] = DIST
    mean: float = Field(ge=1, le=MOST_CYCLES, description="cycles on average", examples=[100])


class UniformCycles(Block):
    """Any number of cycles from low to high, equally likely: what wears out in use."""

    dist: Literal["uniform"] = DIST
    low: Whole = Field(ge=1, le=MOST_CYCLES, description="fewest cycles", examples=[400])
    high: Whole = Field(ge=1, le=MOST_CYCLES, description="most cycles", examples=[500])

    @model_validator(mode="after")
    def _low_first(self) -> UniformCycles:
        if self.low > self.high:
            raise plain_error(f"low ({self.low}) must be at most high ({self.high})", on="low")
        return self


CYCLE_KINDS: dict[str, type[Block]] = {"<geometric cycles>": GeometricCycles, "<uniform cycles>": UniformCycles}
SO_MANY = "<so many>"
Cycles = (
    Annotated[Whole, Field(ge=1, le=MOST_CYCLES), Tag(SO_MANY)]
    | Annotated[GeometricCycles, Tag("<geometric cycles>")]
    | Annotated[UniformCycles, Tag("<uniform cycles>")]
)
"""A whole number of cycles, or a block with numbers where one of a time has quantities."""


def cycles_tag(value: object) -> str | None:
    """Which form of Cycles a value has; None where it has quantities, or is something else."""
    if isinstance(value, int):
        return SO_MANY
    if isinstance(value, GeometricCycles | UniformCycles):
        return f"<{value.dist} cycles>"
    if isinstance(value, dict) and f"<{value.get('dist')} cycles>" in CYCLE_KINDS:
        said = [value[key] for key in ("mean", "low", "high") if key in value]
        return None if any(isinstance(one, str) for one in said) or "step" in value else f"<{value['dist']} cycles>"
    return None
