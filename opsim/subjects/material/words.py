"""Stores, the parts of a product, what a product is split into.

Cards that limit the jobs between two points: CONWIP, kanban, POLCA.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema

from opsim.problems import shown
from opsim.scenario.fields import MOST_PIECES, NameText, Whole, plain_error, unlimited
from opsim.scenario.tree import Block

MOST_INITIAL = 100_000
"""Jobs that may lie in a store at the start."""
MOST_PLACES = 1_000_000_000
ONLY = ""
"""Stands in ``initial`` for the only product that ends in a store."""


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


def _n_cards(value: object) -> object:
    if isinstance(value, int) and not isinstance(value, bool) and value < 1:
        raise plain_error(f"a loop of {value} cards lets no job in", "give it at least one: 'n: 1'")
    return value


def _names(what: str):
    """One name, or a list of them."""

    def read(value: object) -> object:
        names = [value] if isinstance(value, str) else value
        if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
            raise plain_error(f"expected a {what} or a list of them, found {shown(value)}", f"such as {_EXAMPLE[what]}")
        return names

    return BeforeValidator(read)


_EXAMPLE = {"station": "drill", "product": "[a, b]"}
_ONE_OR_MORE = WithJsonSchema(
    {"anyOf": [{"type": "string"}, {"type": "array", "minItems": 1, "items": {"type": "string"}}]}
)
_Points = Annotated[list[str], _names("station"), _ONE_OR_MORE]
_Products = Annotated[list[str], _names("product"), _ONE_OR_MORE]


class Card(Block):
    """A loop of n cards: a job takes one before it enters `from` and gives it back when it leaves `to`.

    Without `from` it is taken before the first station, without `to` given back on the way out: with neither this is
    CONWIP. A loop from a station to the next one on the way is a POLCA loop, one that ends at a store a kanban. Only
    jobs whose way leads from `from` to `to` need a card; who has one does not need another. Pieces that a store holds
    at the start hold cards too. What no source makes, such as the pieces of a split, comes from inside and needs no
    card at its first station, unless `products` names it.
    """

    n: Annotated[Whole, BeforeValidator(_n_cards)] = Field(
        ge=1, le=100_000, description="so many jobs may be between the two points", examples=[8]
    )
    begin: _Points | None = Field(
        None,
        alias="from",
        description="station (or stations) before which a card is taken; absent: the first on the way",
        examples=["drill"],
    )
    end: _Points | None = Field(
        None,
        alias="to",
        description="station (or stations) at whose leaving it is given back, a store: when a piece is taken out; "
        "absent: the way out",
        examples=["paint"],
    )
    products: _Products | None = Field(
        None, description="products that need a card; absent: all that pass", examples=["[a]"]
    )
