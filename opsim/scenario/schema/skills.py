"""Skills: how fast and how well a worker works at a station."""

from __future__ import annotations

from typing import Annotated

from pydantic import AfterValidator, Discriminator, Field, Tag

from opsim.scenario.fields import Name, Rating, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.routing import Probability

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
