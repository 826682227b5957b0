"""How postures are scored: thresholds, and the forks that published methods leave open.

What no posture tells of a task: what is in the hands, how it is held, and what carries the body.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field, ValidationInfo, field_validator, model_validator

from opsim import units
from opsim.ergonomics import options
from opsim.problems import shown
from opsim.scenario.fields import Angle, PathLength, plain_error
from opsim.scenario.tree import Block
from opsim.subjects.tools.words import Moments


class Loaded(Moments):
    """When the load is in the hands: from one moment of each performance to another."""


class Handling(Block):
    """What no posture tells. What is not said widens the scores to an interval, and the report lists it."""

    grip: Literal["good", "fair", "poor", "unacceptable"] | None = Field(
        None, description="how well the load is held (REBA's coupling, NIOSH's coupling multiplier)", examples=["fair"]
    )
    force: Literal["intermittent", "repeated", "static", "shock"] | None = Field(
        None,
        description="how load or force comes: now and then, again and again, held, or as a blow (RULA, REBA)",
        examples=["repeated"],
    )
    forearm: Literal["mid", "end"] | None = Field(
        None, description="how far the forearm is twisted: mid, or near the end of its range (RULA)", examples=["mid"]
    )
    arms_supported: bool | None = Field(None, description="whether something carries the arms (RULA, REBA)")
    sitting: bool | None = Field(None, description="whether he sits (OWAS, REBA)")
    legs: Literal["balanced", "unbalanced"] | None = Field(
        None, description="whether both feet carry the body evenly (RULA, REBA)", examples=["balanced"]
    )
    rapid: bool | None = Field(
        None, description="whether posture changes quickly and far, or the stand is unstable (REBA)"
    )


_USUAL = options.Thresholds()


def _angle(name: str, description: str) -> Any:
    """A threshold of some degrees, with the default and the range that scoring has for it."""
    return Field(math.radians(getattr(_USUAL, name)), alias=name, description=description, examples=["10 deg"])


def _length(name: str, description: str) -> Any:
    return Field(getattr(_USUAL, f"{name}_m"), alias=name, description=description, examples=["10 cm"])


_TINY = 1e-9
_WHY = {
    "trunk_upright": "the next step of the trunk begins at 20 deg",
    "wrist_straight": "the next step of the wrist begins at 15 deg",
    "owas_knee": "it is 180 deg where the leg is straight",
}


def _range(low: float, high: float, kind: str) -> str:
    return f"{units.written(low, kind)} to {units.written(high, kind)}"


class Thresholds(Block):
    """Angles and lengths that the methods' papers give as pictures, or in words only."""

    twist_rad: Angle = _angle("twist", "from which a trunk or a neck is twisted (RULA, REBA)")
    side_rad: Angle = _angle("side", "from which a trunk or a neck is bent sideways (RULA, REBA)")
    abducted_rad: Angle = _angle("abducted", "from which an upper arm is abducted (RULA, REBA)")
    arm_sideways_rad: Angle = _angle(
        "arm_sideways",
        "of abduction, beyond which an upper arm's elevation counts in place of its flexion (RULA, REBA)",
    )
    trunk_upright_rad: Angle = _angle("trunk_upright", "up to which a trunk stands upright, the papers' 0 degrees")
    wrist_straight_rad: Angle = _angle("wrist_straight", "up to which a wrist is straight, RULA's 0 degrees")
    neck_extended_rad: Angle = _angle("neck_extended", "behind its neutral, from which a neck is extended (RULA, REBA)")
    across_m: PathLength = _length("across", "from which a hand is across the midline of the body (RULA)")
    outside_m: PathLength = _length(
        "outside",
        "from which a hand is out to the side of its own shoulder, where the upper arm is not abducted (RULA)",
    )
    owas_back_rad: Angle = _angle("owas_back", "from which a back is bent in OWAS")
    owas_twist_rad: Angle = _angle("owas_twist", "from which a back is twisted or bent sideways in OWAS")
    owas_knee_rad: Angle = _angle("owas_knee", "between thigh and shank, below which a knee is bent in OWAS")
    spread: bool = Field(
        False,
        description="true: scores are intervals over every twist and side threshold from 5 to 20 degrees, which shows "
        "how much hangs on them",
    )

    @field_validator("*")
    @classmethod
    def _in_range(cls, value: Any, info: ValidationInfo) -> Any:
        """Between the steps of the tables beside it."""
        key, _, unit = str(info.field_name).rpartition("_")
        bounds = options.RANGES.get(f"{key}_m" if unit == "m" else key)
        if bounds is not None:
            kind = "length" if unit == "m" else "angle"
            low, high = bounds if unit == "m" else map(math.radians, bounds)
            if not low - _TINY <= value <= high + _TINY:
                found = f"expected {_range(low, high, kind)}, found {units.written(value, kind)}"
                raise plain_error(found, _WHY.get(key, ""))
        return value

    @model_validator(mode="after")
    def _in_order(self) -> Thresholds:
        if self.abducted_rad >= self.arm_sideways_rad:
            there = units.written(self.arm_sideways_rad, "angle")
            found = f"thresholds out of order: an arm counts as abducted before it is sideways, from {there}"
            raise plain_error(found, "write a smaller angle", on="abducted")
        return self


class Rula(Block):
    """Where prints of RULA differ."""

    table_a: Literal["published", "worksheet2000"] = Field(
        "published", description="table A of the paper (1993), or of the worksheet of 2000, lower in 31 of 144 cells"
    )
    force: Literal["paper", "worksheet"] = Field(
        "paper",
        description="paper: 10 kg and more count 2 where they come now and then; worksheet: more than 10 kg always "
        "counts 3",
    )


def _code(value: object) -> str:
    text = str(value) if isinstance(value, int) and not isinstance(value, bool) else value
    if text not in options.DISPUTED:
        raise plain_error(
            f"no code {shown(value)} whose category is disputed",
            f"disputed: {' and '.join(map(repr, options.DISPUTED))}",
        )
    return str(text)


def _sorted(codes: list[str]) -> list[str]:
    return sorted(set(codes))


class Owas(Block):
    """Where prints of OWAS differ."""

    disputed: Annotated[list[Annotated[str, BeforeValidator(_code)]], AfterValidator(_sorted)] = Field(
        [],
        description="codes (back, arms, legs, load) whose other action category is taken",
        examples=["['3373', '4132']"],
    )


class Ergonomics(Block):
    """How postures are scored. Each of these is a choice that changes figures; the assumption sheet names it."""

    rate_hz: float = Field(
        12.0, alias="rate", ge=1, le=60, description="postures looked at in a second of work", examples=[30]
    )
    arm_reference: Literal["trunk", "gravity"] = Field(
        "trunk",
        description="what the upper arm's angles are taken against: an arm that hangs in a stoop is flexed against the "
        "trunk, and not against gravity",
    )
    rula: Rula = Field(default_factory=Rula.model_construct, description="where prints of RULA differ")
    owas: Owas = Field(default_factory=Owas.model_construct, description="where prints of OWAS differ")
    waiting: Literal["unmeasured", "upright"] = Field(
        "unmeasured",
        description="who waits: unmeasured: no posture; upright: stands with hanging arms, which nobody has seen",
    )
    thresholds: Thresholds = Field(
        default_factory=Thresholds.model_construct,
        description="angles that the papers do not give as numbers",
        examples=["{twist: 15 deg}"],
    )
