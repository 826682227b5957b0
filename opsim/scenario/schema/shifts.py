"""Shifts: the hours of a week in which people are there, stations open and sources running."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema

from opsim.clock import DAY_S, DAYS
from opsim.problems import shown
from opsim.scenario.fields import Name, NameText, Seconds, plain_error
from opsim.scenario.schema.base import Block
from opsim.scenario.schema.clock_times import Clock, Days

RULES = Literal["finish", "finish_job", "resume", "resume_any", "hand_over", "restart"]
"""What becomes of the task under way when its worker has to go."""
RULES_SAID = (
    "finish: the task under way is done first; finish_job: all tasks of the job at this station (who is in a team: "
    "those that want one); resume: he stops at once, the job waits, and he goes on with the rest when he is back; "
    "resume_any: he stops at once, and whoever is free first goes on; hand_over: he works on until somebody free has "
    "come and takes over; restart: he stops at once, what was done is lost, and anybody begins anew"
)


def _one_or_several(value: object) -> object:
    """The name of a shift alone is a list of one."""
    if isinstance(value, list) and not value:
        raise plain_error("there is no shift in this list", "name one, or remove the line")
    if not isinstance(value, str | list):
        raise plain_error(
            f"expected a shift or a list of shifts, found {shown(value)}", "such as early, or [early, late]"
        )
    if isinstance(value, list) and len(value) > 1 and all(name == value[0] for name in value):
        raise plain_error(f"{shown(value[0])} follows itself, week by week", f"write {value[0]} alone")
    return [value] if isinstance(value, str) else value


_NAMES = {"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}, "minItems": 1}]}
ShiftNames = Annotated[list[NameText], BeforeValidator(_one_or_several), WithJsonSchema(_NAMES)]


class Pause(Block):
    """A break or a meeting, in every shift that begins on its days."""

    at_s: Clock = Field(
        alias="at", description="when it begins, a time of the day within the shift", examples=["10:00"]
    )
    lasts_s: Seconds = Field(
        alias="lasts",
        description="how long; who is late, because he finishes something, has it in full all the same, but for what "
        "would be after his shift",
        examples=["15 min"],
    )
    place: NameText | None = Field(
        None,
        description="where it is spent, a place of the layout: he walks there and back; absent: where he stands",
        examples=["canteen"],
    )
    days: Days | None = Field(
        None, description="only in shifts that begin on these days; absent: in all", examples=["[Mon]"]
    )


def _within_a_day(most_s: float) -> float:
    if most_s > DAY_S:
        raise plain_error(f"must be at most 24 h, found {most_s / 3600:g} h", "give it in hours, such as 2 h")
    return most_s


class Overtime(Block):
    """Who stays after the end of the shift: whoever jobs on the floor need, where too few of those on duty can do them.

    A job needs him that can come to him in time: through steps that are automatic or that somebody who is there can do,
    and past no automatic run that lasts longer than his overtime. Who is not needed goes at the end of his shift; who
    stays goes as soon as he is needed no more.
    """

    most_s: Annotated[Seconds, AfterValidator(_within_a_day)] = Field(
        alias="most",
        description="so long after the end of the shift, not more than a day, he begins nothing more; what is under "
        "way then ends as at_end says",
        examples=["2 h"],
    )


def _with_most(value: object) -> object:
    if isinstance(value, str):
        raise plain_error(f"expected a block of keys, found {shown(value)}", f"write {{most: {value}}}")
    return value


class Shift(Block):
    """Hours that come back every week. People are on duty in them, a station is open, a source lets jobs in.

    Breaks, meetings, overtime and the two rules are for people alone: a station is open from the first minute to the
    last. A shift that begins before midnight and ends after it belongs to the day on which it begins.
    """

    start_s: Clock = Field(alias="from", description="when it begins, a time of the day", examples=["06:00"])
    end_s: Clock = Field(
        alias="to",
        description="when it ends; not later than it begins: on the next day, so that the same time is 24 h later",
        examples=["14:00"],
    )
    days: Days = Field(list(DAYS), description="the days on which it begins", examples=["[Mon, Tue, Wed, Thu, Fri]"])
    breaks: dict[Name, Pause] = Field({}, description="by name", examples=["{lunch: {at: '11:00', lasts: 30 min}}"])
    meetings: dict[Name, Pause] = Field(
        {},
        description="by name; as breaks, and told apart in the figures",
        examples=["{board: {at: '06:00', lasts: 10 min}}"],
    )
    at_break: RULES = Field("resume", description=f"at breaks and meetings; {RULES_SAID}")
    at_end: RULES = Field("finish", description="as at_break, at the end of the shift")
    overtime: Annotated[Overtime | None, BeforeValidator(_with_most)] = Field(
        None, description="absent: he goes at the end", examples=["{most: 2 h}"]
    )

    @property
    def length_s(self) -> float:
        """Seconds from the beginning to the end: more than 0, at most a day."""
        return (self.end_s - self.start_s) % DAY_S or DAY_S

    def offset_s(self, pause: Pause) -> float:
        """Seconds from the beginning of the shift to that of a pause."""
        return (pause.at_s - self.start_s) % DAY_S
