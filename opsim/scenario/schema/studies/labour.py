"""What differences between people cost: what is asked."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from opsim.kpi.target import read_target
from opsim.problems import shown
from opsim.scenario.fields import NameText, Whole, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.run import OnOff
from opsim.scenario.schema.studies.figures import FigureText

MOST_WORKFORCES, MOST_REPLICATIONS, MOST_MORE = 100_000, 100_000, 20


def _at_least_two(of: str, why: str) -> BeforeValidator:
    def read(value: object) -> object:
        if isinstance(value, int) and not isinstance(value, bool) and value < 2:
            raise plain_error(f"at least 2 {of} are needed, found {shown(value)}", why)
        return value

    return BeforeValidator(read)


_WORKFORCES = _at_least_two("workforces", "one team of people cannot tell how much it matters who is hired")
_REPLICATIONS = _at_least_two(
    "replications of each workforce",
    "with one, who the people are and the luck of the day cannot be told apart",
)


def _known_target(value: object) -> object:
    if not isinstance(value, str):
        raise plain_error(
            f"expected a target, found {shown(value)}", "such as 'throughput_per_h >= 60', or '480 a day'"
        )
    try:
        read_target(value)
    except ValueError as error:
        message, _, hint = str(error).partition("; ")
        raise plain_error(message, hint) from None
    return value


def _off_is_nothing(value: object) -> object:
    """``buy_back: off`` asks for none; YAML 1.1 writers make false of off."""
    return None if value == "off" or value is False else value


Target = Annotated[str, BeforeValidator(_known_target)]


class BuyBack(Block):
    """What may buy back that people differ: more people, or more skills for those who are there."""

    most_workers: Whole = Field(
        2, ge=0, le=MOST_MORE, description="so many people more at most; 0: none is tried", examples=[3]
    )
    most_skills: Whole = Field(
        6, ge=0, le=MOST_MORE, description="so many steps of cross-training at most; 0: none is tried", examples=[4]
    )
    like: list[NameText] | None = Field(
        None,
        description="whom the added people are like; absent: each worker in turn, one of those who are alike",
        examples=["[ana]"],
    )


class Labour(Block):
    """What differences between people cost, and what buys it back."""

    workforces: Annotated[Whole, _WORKFORCES] = Field(
        40, le=MOST_WORKFORCES, description="how many other sets of people are hired", examples=[40]
    )
    replications: Annotated[Whole, _REPLICATIONS] = Field(
        4, le=MOST_REPLICATIONS, description="days of each workforce, each with other luck", examples=[4]
    )
    design: Literal["crossed", "nested"] = Field(
        "crossed",
        description="crossed: all workforces have the same days; nested: each has days of its own",
    )
    figures: list[FigureText] = Field(
        [],
        description="what the budget is made of beside throughput_per_h and work_in_progress; absent: the exposure "
        "figures among the outputs",
        examples=["[fatigue_mean, rula_mean]"],
    )
    budget: OnOff = Field(True, description="off: what each source of variability costs is not asked", examples=["off"])
    alone: OnOff = Field(False, description="on: each source is also tried as the only one", examples=["on"])
    target: Target | None = Field(
        None,
        description="what a day has to reach",
        examples=["480 a day", "throughput_per_h >= 60"],
    )
    buy_back: Annotated[BuyBack | None, BeforeValidator(_off_is_nothing)] = Field(
        BuyBack.model_validate({}),
        description="what may buy the loss back; off: not asked",
        examples=["{most_workers: 3}", "off"],
    )
