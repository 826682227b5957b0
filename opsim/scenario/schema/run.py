"""How long is simulated, how often, and with which luck."""

from __future__ import annotations

import re
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from opsim.clock import DAYS, LONG_DAYS
from opsim.problems import did_you_mean, shown
from opsim.scenario.fields import Seconds, SecondsOrZero, Whole, plain_error
from opsim.scenario.tree import Block

_DAY_WORDS = {*DAYS, *LONG_DAYS}


def _day_and_time(value: object) -> object:
    match = re.fullmatch(r"\s*([A-Za-z]+)\s+([0-9]{1,2}):([0-9]{2})\s*", value) if isinstance(value, str) else None
    if match is None or match[1].title() not in _DAY_WORDS or int(match[2]) > 23 or int(match[3]) > 59:
        raise plain_error(f"expected a weekday and a time, found {shown(value)}", "such as 'Mon 06:00'")
    return f"{match[1][:3].title()} {int(match[2]):02d}:{match[3]}"


def _on_or_off(value: object) -> bool:
    """YAML 1.1 writers make true and false of on and off."""
    if isinstance(value, bool):
        return value
    if not isinstance(value, str) or value not in _SWITCH:
        hint = did_you_mean(value, _SWITCH) if isinstance(value, str) else ""
        raise plain_error(f"expected on or off, found {shown(value)}", hint)
    return _SWITCH[value]


_SWITCH = {"on": True, "off": False}
_ON_OFF = {"anyOf": [{"enum": ["on", "off"]}, {"type": "boolean"}]}
OnOff = Annotated[bool, BeforeValidator(_on_or_off), WithJsonSchema(_ON_OFF)]
"""Written on or off."""


class Run(Block):
    """How long is simulated, how often, and with which luck."""

    start: Annotated[str, BeforeValidator(_day_and_time)] = Field(
        "Mon 06:00", description="weekday and time at t = 0", examples=["Mon 06:00"]
    )
    horizon_s: Seconds = Field(alias="horizon", description="simulated time, end not included", examples=["8 h"])
    warm_up_s: SecondsOrZero = Field(
        0.0, alias="warm_up", description="time at the start that does not count", examples=["30 min"]
    )
    replications: Whole = Field(
        10, ge=1, le=1_000_000, description="how often it is simulated, each with other luck", examples=[30]
    )
    seed: Whole = Field(0, ge=0, lt=2**63, description="the same seed gives the same numbers", examples=[1])
    staffing: Literal["fixed", "redrawn"] = Field(
        "fixed", description="fixed: the same people in every replication; redrawn: other people in each"
    )
    across_tasks: Literal["as_recorded", "same_pace"] = Field(
        "as_recorded",
        description="how a worker's own pace in one task goes with that in others: as_recorded: as with the people "
        "recorded in both, else not at all; same_pace: who is slow in one task is as slow in all, in moving time",
    )
    variability: Literal["full", "within_only", "between_only", "none", "shuffled"] = Field(
        "full",
        description="which differences of task times are left: within_only: everybody has the same mean; between_only: "
        "each worker always takes his own mean; none: everybody always takes the mean; shuffled: times as in full, "
        "each with the body of another performance of the same worker",
    )

    posture: OnOff = Field(
        True,
        description="off: nobody looks at postures, and there is no figure of them; what happens stays as it is",
        examples=["off"],
    )

    @property
    def start_s(self) -> float:
        """Seconds from Monday 00:00 to the start."""
        day, clock = self.start.split()
        hours, minutes = clock.split(":")
        return DAYS.index(day) * 86400.0 + int(hours) * 3600.0 + int(minutes) * 60.0

    @model_validator(mode="after")
    def _warm_up_ends(self) -> Run:
        if self.warm_up_s >= self.horizon_s:
            raise plain_error(
                f"the warm-up ({_time(self.warm_up_s)}) must end before the horizon ({_time(self.horizon_s)})",
                on="warm_up",
                or_on="horizon",
            )
        return self


def _time(seconds: float) -> str:
    """In the largest unit that leaves a whole number, as in ``30 min``."""
    unit, word = next(((unit, word) for unit, word in ((3600, "h"), (60, "min")) if not seconds % unit), (1, "s"))
    return f"{seconds / unit:.12g} {word}"
