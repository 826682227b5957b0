"""Cards that limit the jobs between two points: CONWIP, kanban, POLCA."""

from __future__ import annotations

from typing import Annotated

from pydantic import BeforeValidator, Field, WithJsonSchema

from opsim.problems import shown
from opsim.scenario.fields import Whole, plain_error
from opsim.scenario.schema.base import Block


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
