"""Shifts with their breaks and overtime: times of the day, days of the week, rules of interruption."""

from __future__ import annotations

import re
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema

from opsim.clock import DAY_S, DAYS, LONG_DAYS
from opsim.problems import nearest, shown
from opsim.scenario.fields import Name, NameText, Seconds, plain_error
from opsim.scenario.tree import Block

_BY_WORD = {word.casefold(): short for short, long in zip(DAYS, LONG_DAYS) for word in (short, long)}
_CLOCK = re.compile(r"\s*([0-9]{1,2}):([0-9]{2})(?::([0-9]{2}))?\s*")
_SPOKEN = re.compile(r"\s*([0-9]{1,2})(?:[:.]([0-9]{2}))?\s*([ap])\.?m\.?\s*", re.IGNORECASE)
_SPAN = re.compile(r"\s*([A-Za-z]+)\s*(?:-|\u2013|to)\s*([A-Za-z]+)\s*")


def clock_s(value: object) -> float:
    """Seconds from midnight of a time of the day, "06:00" or "06:00:30"; up to "24:00", which is midnight.

    Raises a plain error for what is no time of the day. A bare number is none, though some YAML writers make one of
    14:00 (840, in base 60).
    """
    match = _CLOCK.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        raise plain_error(f"expected a time of the day, found {shown(value)}", _as_clock(value))
    hours, minutes, seconds = (int(part or 0) for part in match.groups())
    if minutes > 59 or seconds > 59 or hours * 3600 + minutes * 60 + seconds > DAY_S:
        raise plain_error(f"there is no {shown(value)} on the clock", "a day goes from 00:00 to 24:00")
    return hours * 3600.0 + minutes * 60.0 + seconds


def clock_text(seconds: float) -> str:
    """A time of the day, from midnight, as people write it: "16:48"."""
    minutes = round(seconds / 60)
    return f"{minutes // 60:02d}:{minutes % 60:02d}"


def _as_clock(value: object) -> str:
    """How a time of the day is written; of a number that may have been one, counted in minutes."""
    spoken = _SPOKEN.fullmatch(value) if isinstance(value, str) else None
    if spoken is not None and 1 <= int(spoken[1]) <= 12 and int(spoken[2] or 0) <= 59:
        hours = int(spoken[1]) % 12 + (12 if spoken[3].casefold() == "p" else 0)
        return f"write {hours:02d}:{int(spoken[2] or 0):02d}"
    if isinstance(value, int) and not isinstance(value, bool) and 60 <= value <= 24 * 60:
        return f"write '{value // 60:02d}:{value % 60:02d}'"
    return "such as 06:00"


def _day(value: object) -> str:
    day = _BY_WORD.get(value.strip().casefold()) if isinstance(value, str) else None
    if day is None:
        near = nearest(value, [*DAYS, *LONG_DAYS]) if isinstance(value, str) else None
        hint = f"did you mean {shown(_BY_WORD[near.casefold()])}?" if near else f"days: {', '.join(DAYS)}"
        raise plain_error(f"expected a day of the week, found {shown(value)}", hint)
    return day


def _some(value: object) -> object:
    if not isinstance(value, list):
        raise plain_error(f"expected a list of days, found {shown(value)}", _as_list(value))
    if not value:
        raise plain_error("there is no day in this list", "name one, or remove the line: it is then every day")
    return value


def _days(found: list[str]) -> list[str]:
    """Days in the order of the week; each stands once."""
    for number, day in enumerate(found):
        if day in found[:number]:
            raise plain_error(f"{day} stands twice", "remove one of them", on=number)
    return sorted(found, key=DAYS.index)


def _as_list(value: object) -> str:
    """How a list of days is written that was meant by a text, such as ``Mon-Fri``."""
    match = _SPAN.fullmatch(value) if isinstance(value, str) else None
    ends = [_BY_WORD.get(word.casefold()) for word in match.groups()] if match else []
    if len(ends) == 2 and None not in ends:
        first, last = (DAYS.index(str(end)) for end in ends)
        return f"write [{', '.join(DAYS[(first + n) % 7] for n in range((last - first) % 7 + 1))}]"
    day = _BY_WORD.get(value.strip().casefold()) if isinstance(value, str) else None
    return f"write [{day}]" if day else "such as [Mon, Tue, Wed, Thu, Fri]"


_TEXT = {"type": "string", "pattern": r"^\s*([01]?[0-9]|2[0-4]):[0-5][0-9](:[0-5][0-9])?\s*$", "examples": ["06:00"]}
_LIST = {"type": "array", "items": {"enum": [*DAYS, *LONG_DAYS]}, "minItems": 1}
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
Clock = Annotated[float, BeforeValidator(clock_s), WithJsonSchema(_TEXT)]
Days = Annotated[
    list[Annotated[str, BeforeValidator(_day)]], BeforeValidator(_some), AfterValidator(_days), WithJsonSchema(_LIST)
]
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
