"""Times of the day and days of the week, as people write them."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator, BeforeValidator, WithJsonSchema

from opsim.clock import DAY_S, DAYS, LONG_DAYS
from opsim.problems import nearest, shown
from opsim.scenario.fields import plain_error

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
    counted = isinstance(value, int) and not isinstance(value, bool) and 60 <= value <= 24 * 60
    return f"write '{value // 60:02d}:{value % 60:02d}'" if counted else "such as 06:00"  # type: ignore[operator]


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

Clock = Annotated[float, BeforeValidator(clock_s), WithJsonSchema(_TEXT)]
Days = Annotated[
    list[Annotated[str, BeforeValidator(_day)]], BeforeValidator(_some), AfterValidator(_days), WithJsonSchema(_LIST)
]
