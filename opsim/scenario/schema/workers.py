"""Workers, and the rules by which they choose."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from opsim.scenario.fields import Age, Height, Mass, MostLoad, Name, NameText, Pace, Rating, Speed, Whole
from opsim.scenario.schema.base import Block

MOST_WORKERS = 500
"""That a workforce may have."""
PREFIX = "w"


class Person(Block):
    """What every worker may say: body, walking speed, skills. A skill is a rating; 1.1: the duration divided by 1.1."""

    height_m: Height | None = Field(None, alias="height", description="body height", examples=["1.75 m"])
    mass_kg: Mass | None = Field(None, alias="mass", description="body mass", examples=["70 kg"])
    age_years: Age | None = Field(None, alias="age", description="age in years", examples=[41])
    sex: Literal["f", "m"] | None = Field(None, description="f or m", examples=["f"])
    pace: Pace | None = Field(
        None,
        description="1.1: a tenth faster than the typical person in emulated tasks; for other times say it by skills",
        examples=[1.1],
    )
    walk_m_per_s: Speed = Field(1.2, alias="walk", description="walking speed", examples=["1.2 m/s"])
    most_load_kg: MostLoad | None = Field(
        None,
        alias="most_load",
        description="what the worker carries at once from station to station; more needs several walks",
        examples=["15 kg"],
    )
    skills: dict[str, Rating] = Field(
        {},
        description="rating by station, a number (1.1: a tenth faster) or the name of a skill level",
        examples=["{pack: 1.0}"],
    )
    home: NameText | None = Field(None, description="the place where the worker stands at the start")
    patrol: list[NameText] | None = Field(
        None, min_length=1, description="stations to go round when idle, in this order", examples=["[pack, check]"]
    )


class Worker(Person):
    """A person with a name."""

    person: NameText | None = Field(
        None, description="a recorded person: the worker moves and takes his time as he does", examples=["s03"]
    )


class Workforce(Person):
    """So many workers more, called w1, w2 and so on, each with the keys that are given here."""

    n: Whole = Field(ge=1, le=MOST_WORKERS, description="how many workers", examples=[12])
    source: Literal["population", "recorded"] = Field(
        "population",
        alias="from",
        description="population: new people, drawn; recorded: the k-th is the k-th recorded person in natural order of "
        "names",
    )
    prefix: Name = Field(PREFIX, description="what their names begin with", examples=["w"])


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
