"""Time on a grid of 2^-20 s: sums are exact, ties are real, and pieces end when they should.

The grid holds up to 2^33 s (272 years) in a float without loss.

A moment of a run as people say it: '90 min' after its start, or 'Mon 07:30' on the week's clock.
"""

from __future__ import annotations

import re

TICKS_PER_S = 2**20
STEP_S = 1 / TICKS_PER_S
LONGEST_S = 2.0**33


def on_grid(delay_s: float) -> float:
    """A delay rounded once to a multiple of 2^-20 s, at least one of them."""
    n_ticks = round(delay_s * TICKS_PER_S)
    return (n_ticks if n_ticks > 1 else 1) / TICKS_PER_S


def ticks(times_s):
    """Times on the grid as whole ticks (int64), for sums that must be exact."""
    import numpy as np

    return np.rint(np.asarray(times_s) * TICKS_PER_S).astype(np.int64)


DAYS = ("Mon", "Tue", "Wed", "Thu", "Fri", "Sat", "Sun")
LONG_DAYS = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")
DAY_S, WEEK_S = 86_400.0, 604_800.0


def on_the_clock(time_s: float) -> str:
    """Seconds from midnight of any day as a time of the day: "06:00", with seconds only where there are some."""
    minutes, seconds = divmod(round(time_s % DAY_S), 60)
    text = f"{minutes // 60 % 24:02d}:{minutes % 60:02d}"
    return f"{text}:{seconds:02d}" if seconds else text


_CLOCK = r"\s*(?:([A-Za-z]+)\s+)?([0-9]{1,2}):([0-9]{2})(?::([0-9]{2}(?:\.[0-9]+)?))?\s*"
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

    match = re.fullmatch(_CLOCK, text)
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
