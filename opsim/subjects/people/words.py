"""Skills: how fast and how well a worker works at a station.

Workers, the rules by which they choose, and job rotation.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Discriminator, Field, Tag, WithJsonSchema, model_validator

from opsim.problems import shown
from opsim.scenario.fields import (
    Age,
    Height,
    Mass,
    MostLoad,
    Name,
    NameText,
    Pace,
    Probability,
    Rating,
    Seconds,
    Speed,
    Whole,
    plain_error,
)
from opsim.scenario.tree import Block
from opsim.subjects.shifts.words import ShiftNames

RATING, SKILL = "<rating>", "<skill>"


def _some(value: float) -> float:
    if value == 0:
        raise plain_error("a quality must be more than 0: nothing good would ever come out", "such as 0.97")
    return value


class Skill(Block):
    """How fast and how well somebody works at a station."""

    pace: Rating = Field(1.0, description="rating; 1.1: the duration divided by 1.1", examples=[1.1])
    quality: Annotated[Probability, AfterValidator(_some)] = Field(
        1.0,
        description="share of operations that he leaves without a defect, times the yield of the station; where "
        "several work on an operation, the lowest of theirs counts",
        examples=[0.99],
    )


def skill_tag(value: object) -> str:
    """Which form a skill has: a number alone is its pace."""
    return SKILL if isinstance(value, dict | Skill) else RATING


SkillText = Annotated[Annotated[Rating, Tag(RATING)] | Annotated[Skill, Tag(SKILL)], Discriminator(skill_tag)]
Skills = dict[str, SkillText]
SkillLevels = dict[Name, SkillText]
MOST_WORKERS = 500
"""That a workforce may have."""
PREFIX = "w"
USUAL_WALK_M_PER_S = 1.2
Repetitions = Annotated[float, Field(ge=0, le=1e9)]


def _once(names: list[str]) -> list[str]:
    twice = [number for number, name in enumerate(names) if name in names[:number]]
    if twice:
        raise plain_error(f"{names[twice[0]]!r} is named twice", on=twice[0])
    return names


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
    walk_m_per_s: Speed = Field(USUAL_WALK_M_PER_S, alias="walk", description="walking speed", examples=["1.2 m/s"])
    most_load_kg: MostLoad | None = Field(
        None,
        alias="most_load",
        description="what the worker carries at once from station to station; more needs several walks",
        examples=["15 kg"],
    )
    skills: Skills = Field(
        {},
        description="by station: a pace (1.1: a tenth faster), the name of a skill level, or pace and quality",
        examples=["{pack: 1.0}"],
    )
    zone: Annotated[list[NameText], AfterValidator(_once)] | None = Field(
        None,
        min_length=1,
        description="his own stations: he goes to another one that he has the skill for only where none of these "
        "calls, and neither anybody whose own it is nor a floater is free; absent: all of them are his own",
        examples=["[pack, label]"],
    )
    floater: bool = Field(
        False,
        description="one who steps in: he is sent only where nobody is free whose own station it is, but before people "
        "are drawn out of their zones; where he has a zone, he leaves it last of all",
    )
    shift: ShiftNames | None = Field(
        None,
        description="when the worker is there: a shift, or several that follow each other week by week, the first in "
        "the week of the start; absent: always",
        examples=["early", "[early, late]"],
    )
    absence: Probability | None = Field(
        None,
        description="share of his shifts that he does not come to, each drawn by itself; what waits for him to go on "
        "with is then for anybody; where a missed shift follows at once on another, he first finishes what at_end "
        "says; absent: what `human.absence` says, else none",
        examples=[0.05],
    )
    experience: dict[NameText, Repetitions] = Field(
        {},
        description="repetitions behind him at the start, by task; for learning",
        examples=["{pick_up: 200}"],
    )
    home: NameText | None = Field(
        None, description="the place where the worker stands at the start", examples=["bench"]
    )
    patrol: list[NameText] | None = Field(
        None, min_length=1, description="stations to go round when idle, in this order", examples=["[pack, check]"]
    )

    @model_validator(mode="after")
    def _absent_from_shifts(self) -> Person:
        if self.absence is not None and self.absence > 0 and self.shift is None:
            raise plain_error("who has no shift is always there", "name the shift that is missed", on="absence")
        return self


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
        description="which of the stations that call a free worker goes to; least_exposed: of those who could be sent "
        "goes whose body has gone through least so far (RULA x time at work, by a few draws of his own for each task), "
        "to the oldest call; a plug-in may bring more rules",
        examples=["longest_queue", "nearest", "oldest_job", "most_downstream", "best_skill", "least_exposed"],
    )
    priorities: Annotated[list[Literal["stations", "products"]], AfterValidator(_once)] = Field(
        ["stations"],
        description="what comes before the rule, in this order: the priority of stations, that of the jobs that call "
        "there; zones and floaters come before both; an empty list: neither, only the rule",
        examples=["[products, stations]"],
    )
    idle: Literal["stay", "home", "patrol"] = Field(
        "stay",
        description="what a worker does whom nobody calls: stay, go home, or go round the stations of his patrol",
    )
    serve: Literal["exhaustive", "one"] = Field(
        "exhaustive",
        description="what somebody on patrol does at a station before he walks on: all jobs until nobody calls there, "
        "or one operation",
    )
    when_blocked: Literal["free", "held"] = Field(
        "free", description="whether a worker whose job cannot move on is free, or stays with it"
    )


IN_TURN = "in_turn"


def _post(value: object) -> object:
    """One station by its name is a post too."""
    if isinstance(value, str):
        return [value]
    if not isinstance(value, list):
        raise plain_error(f"expected a station or a list of them, found {shown(value)}", "such as [pack]")
    return value


_ONE_OR_MORE = WithJsonSchema({"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]})
Post = Annotated[list[NameText], BeforeValidator(_post), _ONE_OR_MORE]


class Rotation(Block):
    """People who change posts. A post is a station, or a few; who has a post works at no other post of the rotation.

    The members who are there man the posts in the order of the lists, then each post a second time, and so on; at each
    change everybody moves up by one post. Where there are fewer people than posts they go on to the empty ones. A post
    goes to somebody with a skill for it, where there is one. What was begun is finished at the old post. A break
    changes nothing; when somebody goes off shift or comes back, posts are given out anew. Stations in no post, and
    people who are no members, are as ever.
    """

    workers: list[NameText] = Field(min_length=1, description="who changes posts", examples=["[ana, ben, cem]"])
    posts: list[Post] = Field(
        min_length=2,
        description="the posts, each a station or a list of them; an empty list is a rest, or work at stations that "
        "are in no post",
        examples=["[pack, label, [lift, stack]]"],
    )
    every_s: Seconds | None = Field(
        None,
        alias="every",
        description="by the clock, from the start of the run: time between changes",
        examples=["2 h"],
    )
    after: Whole | None = Field(
        None,
        ge=1,
        le=1_000_000,
        description="by count: everybody changes when so many operations were done at one of the posts since the last "
        "change",
        examples=[50],
    )
    rule: NameText = Field(
        IN_TURN,
        description="who takes which post at a change: in_turn (everybody moves up by one), least_time (each post, the "
        "first of the list first, goes to who was there for the shortest time so far), least_exposed (each post, the "
        "heaviest first, goes to whose body has gone through least so far, RULA x time at work), or a plug-in's; "
        "alone, without `every` and `after`, it is asked whenever an operation is done at one of the posts",
        examples=["least_time", "least_exposed"],
    )

    @model_validator(mode="after")
    def _at_some_time(self) -> Rotation:
        if self.every_s is not None and self.after is not None:
            raise plain_error(
                "changes by the clock (every) and by count (after) both", "remove one of them", on="after"
            )
        if self.every_s is None and self.after is None and "rule" not in self.model_fields_set:
            found = "nothing says when people change posts"
            raise plain_error(found, "add 'every: 2 h', 'after: 50' or 'rule: least_time'")
        return self
