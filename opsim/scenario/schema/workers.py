"""Workers, and the rules by which they choose."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from opsim.scenario.fields import Height, Mass, NameText, Speed
from opsim.scenario.schema.base import Block


class Worker(Block):
    """A person: body, walking speed, skills. A skill is a rating; 1.1 means the duration divided by 1.1."""

    height_m: Height | None = Field(None, alias="height", description="body height", examples=["1.75 m"])
    mass_kg: Mass | None = Field(None, alias="mass", description="body mass", examples=["70 kg"])
    walk_m_per_s: Speed = Field(1.2, alias="walk", description="walking speed", examples=["1.2 m/s"])
    skills: dict[str, Annotated[float, Field(ge=0.01, le=10)]] = Field(
        {}, description="rating by station; 1.1: a tenth faster", examples=["{pack: 1.0}"]
    )
    home: NameText | None = Field(None, description="the place where the worker stands at the start")
    patrol: list[NameText] | None = Field(
        None, min_length=1, description="stations to go round when idle, in this order", examples=["[pack, check]"]
    )


class Allocation(Block):
    """The rules by which workers choose."""

    rule: NameText = Field(
        "longest_queue",
        description="which of the stations that call a free worker goes to; a plug-in may bring more rules",
        examples=["longest_queue", "nearest", "oldest_job"],
    )
    idle: Literal["stay", "home", "patrol"] = Field(
        "stay",
        description="what a worker does whom nobody calls: stay, go home, or go round the stations of his patrol",
    )
    when_blocked: Literal["free", "held"] = Field(
        "free", description="whether a worker whose job cannot move on is free, or stays with it"
    )
