"""What no posture tells of a task: what is in the hands, how it is held, and what carries the body."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from opsim.scenario.schema.base import Block
from opsim.scenario.schema.tools import Moments


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
