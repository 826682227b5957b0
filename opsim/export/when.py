"""A time of a run, as people say it: "Tue 10:15:30" on the week's clock, or seconds since the run began."""

from __future__ import annotations

import re

from opsim.clock import DAY_S, DAYS, WEEK_S, on_the_clock
from opsim.units import UnitError, parse

_CLOCK = re.compile(r"(?:([A-Za-z]{3})[a-z]*\s+)?([0-9]{1,2}):([0-5][0-9])(?::([0-5][0-9](?:\.[0-9]+)?))?")


def run_s(text: str, start_s: float, horizon_s: float) -> float:
    """Seconds on the run's clock: the first such time of the run; "90 min" is since the run began.

    Raises ValueError where it cannot be read, or lies outside the run.
    """
    found_s = _read_s(text, start_s)
    if not 0 <= found_s < horizon_s:
        first, last = said(start_s), said(start_s + horizon_s)
        raise ValueError(f"--at {text!r}: found a time outside the run, expected one from {first} to before {last}")
    return found_s


def start_of(start: str) -> float:
    """When a run begins, as its summary says it ("Mon 06:00"), in seconds after Monday 00:00."""
    day, clock = start.split()
    hours, minutes = clock.split(":")
    return DAYS.index(day) * DAY_S + int(hours) * 3600.0 + int(minutes) * 60.0


def said(clock_s: float) -> str:
    """Seconds after Monday 00:00 as a day and a time: "Tue 10:15:30"."""
    return f"{DAYS[int(round(clock_s) // DAY_S) % 7]} {on_the_clock(clock_s)}"


def _read_s(text: str, start_s: float) -> float:
    clock = _CLOCK.fullmatch(text.strip())
    if clock is None:
        try:
            return parse(text, "time")
        except UnitError as error:
            raise ValueError(f"--at {text!r}: {error}; or a time such as 'Tue 10:15:30'") from None
    day, hour, minute, second = clock.groups()
    of_day_s = 3600 * int(hour) + 60 * int(minute) + float(second or 0)
    if day is None:
        return (of_day_s - start_s) % DAY_S
    if day.capitalize() not in DAYS:
        raise ValueError(f"--at {text!r}: found no day {day!r}, expected one of {', '.join(DAYS)}")
    return (DAYS.index(day.capitalize()) * DAY_S + of_day_s - start_s) % WEEK_S
