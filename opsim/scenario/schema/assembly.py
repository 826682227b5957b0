"""What comes together and apart: stores, the parts of a product, what a product is split into, batches on a server."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema

from opsim.problems import shown
from opsim.scenario.fields import NameText, Seconds, Whole, plain_error
from opsim.scenario.schema.base import Block

MOST_PIECES = 10_000
"""Pieces of one part in a product, units in a lot, jobs in a batch."""
MOST_INITIAL = 100_000
"""Jobs that may lie in a store at the start."""
MOST_PLACES = 1_000_000_000
ONLY = ""
"""Stands in ``initial`` for the only product that ends in a store."""


def unlimited(value: object) -> object:
    """None for 'unlimited'; other text is refused."""
    if isinstance(value, str):
        if value != "unlimited":
            raise plain_error(f"expected a whole number or unlimited, found {shown(value)}")
        return None
    return value


def _capacity(value: object) -> object:
    found = unlimited(value)
    if isinstance(found, int) and not isinstance(found, bool) and not 1 <= found <= MOST_PLACES:
        raise plain_error(f"a store has from 1 to {MOST_PLACES:,} places, found {shown(value)}")
    return found


def _by_product(value: object) -> dict[str, int]:
    """Numbers by product; a number alone is of the only product."""
    by_product: dict = value if isinstance(value, dict) else {ONLY: value}
    for product, number in by_product.items():
        on = None if product == ONLY else product
        if isinstance(number, bool) or not isinstance(number, int):
            hint = "such as 4 or {wheel: 4}"
            raise plain_error(f"expected a whole number, or numbers by product, found {shown(number)}", hint, on=on)
        if not 0 <= number <= MOST_INITIAL:
            raise plain_error(f"must be from 0 to {MOST_INITIAL:,}, found {shown(number)}", on=on)
    return by_product


_PLACES = {"anyOf": [{"type": "integer", "minimum": 1, "maximum": MOST_PLACES}, {"const": "unlimited"}]}
Capacity = Annotated[Whole | None, BeforeValidator(_capacity), WithJsonSchema(_PLACES)]
_WHOLE = {"type": "integer", "minimum": 0, "maximum": MOST_INITIAL}
_INITIAL = {"anyOf": [_WHOLE, {"type": "object", "additionalProperties": _WHOLE}]}
Pieces = Annotated[Whole, Field(ge=1, le=MOST_PIECES)]
PiecesByStation = dict[NameText, dict[NameText, Pieces]]
Initial = Annotated[dict[str, int], BeforeValidator(_by_product), WithJsonSchema(_INITIAL)]


class Store(Block):
    """Where products wait until they are taken as parts: those whose route ends here, the oldest taken first."""

    at: NameText = Field(description="a place of the layout", examples=["rack"])
    capacity: Capacity | None = Field(
        None, description="jobs that fit, a lot is one; absent or 'unlimited': no limit", examples=["20"]
    )
    initial: Initial = Field(
        {},
        description="jobs that lie here at the start: a number, or numbers by product where several end here",
        examples=["4"],
    )


class Batch(Block):
    """Several jobs at once on one server, such as in an oven: its tasks are done once for all of them together.

    A batch begins when it is full, or when the first job of it has waited as long as it may.
    """

    size: Whole = Field(ge=2, le=MOST_PIECES, description="jobs on a server at once, a lot is one", examples=[4])
    most_wait_s: Seconds | None = Field(
        None,
        alias="most_wait",
        description="a job that has waited so long takes a server with those there are; absent: waits for a full batch",
        examples=["10 min"],
    )
    of: Literal["any", "product", "family"] = Field(
        "any", description="which jobs go together: any, those of one product, or those of one family"
    )
