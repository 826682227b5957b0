"""A moment of a run as people say it: '90 min' after its start, or 'Mon 07:30' on the week's clock."""

from __future__ import annotations

import re

from opsim.clock import DAY_S, DAYS, LONG_DAYS, WEEK_S, on_the_clock

_CLOCK = re.compile(r"\s*(?:([A-Za-z]+)\s+)?([0-9]{1,2}):([0-9]{2})(?::([0-9]{2}(?:\.[0-9]+)?))?\s*")
_DAYS = {name: number for number, names in enumerate(zip(DAYS, LONG_DAYS)) for name in names}


def moment_s(text: str, start_s: float, after_s: float = 0.0) -> float:
    """Seconds since the run's start; of a clock the first such moment from ``after_s`` on.

    start_s : of the run, seconds after Monday 00:00. Raises ValueError where the text is neither.
    """
    from opsim.units import UnitError, parse

    if ":" in text:
        return _clock_s(text, start_s, after_s)
    try:
        return parse(text, "time")
    except UnitError as error:
        raise ValueError(f"{error.message}; write '2 h' or a clock, 'Mon 07:30'") from None


def clock_words(at_s: float, start_s: float = 0.0) -> str:
    """``Mon 07:30``, with seconds only where there are some; start_s : of the run, seconds after Monday 00:00."""
    since_monday_s = round(start_s + at_s)
    return f"{DAYS[int(since_monday_s // DAY_S) % 7]} {on_the_clock(since_monday_s)}"


def _clock_s(text: str, start_s: float, after_s: float) -> float:
    from opsim.problems import did_you_mean, shown

    match = _CLOCK.fullmatch(text)
    if match is None or int(match[2]) > 23 or int(match[3]) > 59 or float(match[4] or 0) >= 60:
        raise ValueError(f"cannot read {shown(text)} as a clock; write 'Mon 07:30' or '07:30'")
    of_day_s = int(match[2]) * 3600.0 + int(match[3]) * 60.0 + float(match[4] or 0)
    if match[1] is None:
        return _next_s(of_day_s, DAY_S, start_s, after_s)
    day = match[1].title()
    if day not in _DAYS:
        raise ValueError(f"no weekday {shown(match[1])}; {did_you_mean(day, _DAYS)}")
    return _next_s(_DAYS[day] * DAY_S + of_day_s, WEEK_S, start_s, after_s)


def _next_s(clock_s: float, every_s: float, start_s: float, after_s: float) -> float:
    """The first moment from ``after_s`` on at which a clock of that period shows ``clock_s``."""
    return after_s + (clock_s - start_s - after_s) % every_s
