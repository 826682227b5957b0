"""Quality at a station: what its work leaves wrong, and what becomes of it."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema, model_validator

from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import Probability, Whole, plain_error
from opsim.scenario.tree import Block

_SCRAP = "scrap"
_THEN = {
    "anyOf": [
        {"const": _SCRAP},
        {
            "type": "object",
            "properties": {
                "rework": {"type": "string", "description": "the station that puts it right", "examples": ["solder"]}
            },
            "required": ["rework"],
            "additionalProperties": False,
        },
    ]
}


def _some(value: float) -> float:
    if value == 0:
        raise plain_error("a yield must be more than 0: nothing good would ever come out", "such as 0.97")
    return value


def _not_all(value: float) -> float:
    if value == 1:
        raise plain_error("this must be less than 1: nothing would ever pass", "such as 0.02")
    return value


def _then(value: object) -> object:
    """``scrap`` is no station; ``{rework: STATION}`` is that station."""
    if value == _SCRAP:
        return None
    if isinstance(value, dict) and list(value) == ["rework"] and isinstance(value["rework"], str):
        return value["rework"]
    keys = [key for key in value if key != "rework"] if isinstance(value, dict) else []
    near = did_you_mean(keys[0], ["rework"]) if keys else did_you_mean(value, [_SCRAP])
    hint = near if near.startswith("did") else "such as {rework: solder}"
    raise plain_error(f"expected scrap or {{rework: STATION}}, found {shown(value)}", hint)


Yield = Annotated[Probability, AfterValidator(_some)]
LessThanAll = Annotated[Probability, AfterValidator(_not_all)]


class Inspect(Block):
    """A look at each job whose work here is done: what is wrong with it is found, or not.

    A job is good or bad as a whole, a lot too. What was reworked is good until some operation leaves a defect anew.
    """

    finds: Probability = Field(1.0, description="share of bad jobs that are found to be bad", examples=[0.95])
    false_alarms: LessThanAll = Field(0.0, description="share of good jobs that are held to be bad", examples=[0.02])
    rework: Annotated[str | None, BeforeValidator(_then), WithJsonSchema(_THEN)] = Field(
        None,
        alias="then",
        description="scrap, or {rework: STATION}: on the job's way, it goes on from there; elsewhere, it is brought "
        "back here to be inspected again",
        examples=["scrap", "{rework: solder}"],
    )
    most: Whole | None = Field(
        None,
        ge=1,
        le=1_000_000,
        description="so many reworks of a job, then scrap; absent: as many as it takes",
        examples=[2],
    )

    @model_validator(mode="after")
    def _most_of_reworks(self) -> Inspect:
        if self.most is not None and self.rework is None:
            raise plain_error(
                "most counts reworks, and nothing is reworked here", "add e.g. 'then: {rework: solder}'", on="most"
            )
        return self


def one_word_on_scrap(station: Any) -> None:
    """``scrap`` says yield and inspection in one. Raises where a station says one of them as well."""
    if station.scrap_share is None:
        return
    other = "yield" if station.yield_share is not None else "inspect" if station.inspect is not None else None
    if other is not None:
        said = f"'scrap: {station.scrap_share:g}' is 'yield: {1 - station.scrap_share:g}'"
        hint = f"keep one of them: {said}, and all of it found here"
        raise plain_error(f"scrap and {other} both say what becomes of bad work", hint, on=other)
