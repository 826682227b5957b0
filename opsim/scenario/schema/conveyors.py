"""Conveyors: belts and roller tracks that take jobs from one place to another."""

from __future__ import annotations

from pydantic import Field, model_validator

from opsim.scenario.fields import BeltSpeed, NameText, Pitch, plain_error
from opsim.scenario.schema.base import Block


class Conveyor(Block):
    """A belt, used as a step of a route: a job rides it from end to end in length / speed, in the order it got on.

    Jobs are at least ``pitch`` apart, so one gets on every pitch / speed at most, and length / pitch of them (rounded
    up) are on it at once. A job at the end stays there until its next step has room.
    """

    start: NameText = Field(alias="from", description="the place where jobs get on", examples=["press"])
    end: NameText = Field(alias="to", description="the place where jobs get off", examples=["pack"])
    speed_m_per_s: BeltSpeed = Field(alias="speed", description="how fast it moves", examples=["0.2 m/s"])
    pitch_m: Pitch = Field(
        alias="pitch", description="room that a job takes, its gap to the next included", examples=["0.5 m"]
    )
    length_m: Pitch | None = Field(
        None, alias="length", description="else that of the straight line between its ends", examples=["6 m"]
    )
    accumulating: bool = Field(
        True,
        description="true: jobs close up behind one that waits at the end; false: then the whole belt stands still",
    )

    @model_validator(mode="after")
    def _room_for_one(self) -> Conveyor:
        if self.length_m is not None and self.length_m < self.pitch_m:
            found = f"a belt of {self.length_m:g} m has no room for a job of {self.pitch_m:g} m"
            raise plain_error(found, "make the belt longer or the pitch smaller", on="length")
        return self
