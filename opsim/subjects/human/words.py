"""What becomes of people as they work. Every effect is off unless it is named."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from pydantic import (
    Field,
)

from opsim.scenario.fields import Probability
from opsim.scenario.tree import Block
from opsim.subjects.human.effect_blocks import one_of

if TYPE_CHECKING:
    Learning: TypeAlias = Any
    Forgetting: TypeAlias = Any
    Fatigue: TypeAlias = Any
    Rest: TypeAlias = Any
    StatePace: TypeAlias = Any
    Circadian: TypeAlias = Any
    Errors: TypeAlias = Any
else:
    Learning, Forgetting = one_of("learning"), one_of("forgetting")
    Fatigue, Rest = one_of("fatigue"), one_of("rest")
    StatePace, Circadian, Errors = one_of("state_pace"), one_of("circadian"), one_of("errors")


class Human(Block):
    """What becomes of people as they work. Every effect is off unless it is named, and each stands by its source."""

    acts_on: Literal["posture", "time"] = Field(
        "posture",
        description="what slows a person changes: posture: he moves as people do who take longer, which goes beyond "
        "what was recorded; time: the time alone; learning is always of the time",
    )
    learning: Learning | None = Field(
        None, description="times fall with repetitions", examples=["{model: wright, rate: 0.85}"]
    )
    forgetting: Forgetting | None = Field(
        None, description="what was learned fades while a task is not done", examples=["{model: lfcm}"]
    )
    fatigue: Fatigue | None = Field(
        None, description="who works tires, who rests recovers; fatigue slows", examples=["{model: lffrm}"]
    )
    state_pace: StatePace | None = Field(
        None, description="people are quicker or slower by what waits for them", examples=["{model: schultz}"]
    )
    circadian: Circadian | None = Field(
        None, description="the time of the day", examples=["{amplitude: 0.05, peak: '16:00'}"]
    )
    rest: Rest | None = Field(
        None,
        description="rest by need: who is too tired rests, until he has recovered enough",
        examples=["{above: 0.5, until: 0.2}"],
    )
    errors: Errors | None = Field(
        None, description="who is tired leaves more defects", examples=["{at_full_fatigue: 0.1}"]
    )
    absence: Probability | None = Field(
        None,
        description="share of shifts missed, of everybody with a shift who does not say his own",
        examples=[0.05],
    )
