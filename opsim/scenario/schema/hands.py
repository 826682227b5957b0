"""Where hands go at a mark of a movement: to one height, by product, or to one layer after the other."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag, WithJsonSchema

from opsim import units
from opsim.problems import shown
from opsim.scenario.fields import NameText, Whole, plain_error
from opsim.scenario.tree import Block

HEIGHT, LAYERS, BY_PRODUCT = "<height>", "<layers>", "<by product>"
_HAND = "such as rack.low, a level of a place, or 0.4 m above the floor"


def hand_height(value: object) -> float | tuple[str, str]:
    """Metres above the floor, or (place, level): of ``0.4 m`` and of ``rack.low``. Raises an error in our words."""
    if isinstance(value, str):
        place, _, level = (part.strip() for part in value.rpartition("."))
        is_number = value.strip()[:1] in "+-.0123456789"
        if place and level and not (is_number and (level[0].isdecimal() or place.lstrip("+-").isdecimal())):
            return place, level
        if not is_number:
            raise plain_error(f"expected a height, found {shown(value)}", _HAND)
    try:
        height_m = units.parse(value, "length")
    except units.UnitError as error:
        raise plain_error(error.message, error.hint or _HAND) from None
    if height_m < 0:
        raise plain_error(f"must be at least 0 m, found {shown(value)}", "heights count from the floor")
    return height_m


HandHeight = Annotated[
    float | tuple[str, str],
    BeforeValidator(hand_height),
    WithJsonSchema({"type": "string", "pattern": r"\S", "examples": ["rack.low", "0.4 m"]}),
]


class Layers(Block):
    """Heights that are used up in turn, as a pallet empties; after the last one comes a new full pallet."""

    layers: list[HandHeight] = Field(
        min_length=1,
        description="heights in the order in which they are used up",
        examples=["[pallet.top, pallet.middle, pallet.bottom]"],
    )
    pieces_each: Annotated[Whole, Field(ge=1)] = Field(
        description="how many times the task is begun at each of them", examples=["8"]
    )


def hand_tag(value: Any) -> str:
    """Which of the three forms a value has; a block with a list in it is one of layers."""
    if isinstance(value, Layers):
        return LAYERS
    if not isinstance(value, dict):
        return HEIGHT
    layered = {"layers", "pieces_each"} & set(value) or any(isinstance(one, list) for one in value.values())
    return LAYERS if layered else BY_PRODUCT


def _no_list(value: object) -> object:
    if value == {}:
        raise plain_error("expected a height, found {}", "by product such as {carton: rack.low, case: rack.top}")
    if isinstance(value, list):
        hint = "in turn such as {layers: [pallet.top, pallet.bottom], pieces_each: 8}"
        raise plain_error(f"expected a height, found {shown(value)}", hint)
    return value


Hand = Annotated[
    Annotated[HandHeight, Tag(HEIGHT)]
    | Annotated[Layers, Tag(LAYERS)]
    | Annotated[dict[NameText, HandHeight], Tag(BY_PRODUCT)],
    Discriminator(hand_tag),
    BeforeValidator(_no_list),
]
