"""A stretch of a run as people say it: '2 h' after its start, or 'Mon 07:30' on its clock."""

from __future__ import annotations

import re

from opsim.clock import DAY_S, DAYS, WEEK_S

_CLOCK = re.compile(r"\s*(?:([A-Za-z]+)\s+)?([0-9]{1,2}):([0-9]{2})(?::([0-9]{2}))?\s*")


def window_s(low: str | None, high: str | None, start_s: float, horizon_s: float) -> tuple[float, float] | None:
    """(low, high) in seconds since the run's start; None where all of it is meant.

    start_s : of the run, seconds after Monday 00:00
    A clock is the first such moment of the run, for ``high`` after ``low``. Raises ValueError with every mistake.
    """
    if low is None and high is None:
        return None
    wrong: list[str] = []
    low_s = 0.0 if low is None else _end("--from", low, start_s, horizon_s, 0.0, wrong)
    high_s = horizon_s if high is None else _end("--to", high, start_s, horizon_s, low_s, wrong)
    if not wrong and low_s >= high_s:
        found = f"{clock_words(low_s, start_s)} and {clock_words(high_s, start_s)}"
        wrong.append(f"--from and --to: found {found}, expected the later one last")
    if wrong:
        raise ValueError("\n".join(wrong))
    return low_s, high_s


def _end(option: str, text: str, start_s: float, horizon_s: float, after_s: float, wrong: list[str]) -> float:
    """One end of a stretch; what is wrong with it is added to ``wrong``."""
    from opsim.problems import shown

    try:
        at_s = moment_s(text, start_s, after_s)
    except ValueError as error:
        wrong.append(f"{option}: {error}")
        return after_s
    if not 0 <= at_s <= horizon_s:
        found = clock_words(at_s, start_s) if at_s >= 0 else "before the start"
        run = f"{clock_words(0.0, start_s)} to {clock_words(horizon_s, start_s)} ({horizon_s / 3600:.4g} h)"
        wrong.append(f"{option}: found {shown(text)} ({found}), expected a moment of the run, {run}")
        return after_s
    return at_s


def moment_s(text: str, start_s: float, after_s: float = 0.0) -> float:
    """Seconds since the run's start; of a clock the first such moment from ``after_s`` on. Raises ValueError."""
    from opsim.units import UnitError, parse

    if ":" in text:
        return _clock_s(text, start_s, after_s)
    try:
        return parse(text, "time")
    except UnitError as error:
        raise ValueError(f"{error.message}; write '2 h' or a clock, 'Mon 07:30'") from None


def clock_words(at_s: float, start_s: float) -> str:
    """``Mon 07:30``, with seconds only where there are some; start_s : of the run, seconds after Monday 00:00."""
    from opsim.clock import on_the_clock

    since_monday_s = round(start_s + at_s)
    return f"{DAYS[int(since_monday_s // DAY_S) % 7]} {on_the_clock(since_monday_s)}"


def _clock_s(text: str, start_s: float, after_s: float) -> float:
    from opsim.problems import did_you_mean, shown

    match = _CLOCK.fullmatch(text)
    if match is None or int(match[2]) > 23 or int(match[3]) > 59 or int(match[4] or 0) > 59:
        raise ValueError(f"cannot read {shown(text)} as a clock; write 'Mon 07:30' or '07:30'")
    of_day_s = int(match[2]) * 3600.0 + int(match[3]) * 60.0 + int(match[4] or 0)
    if match[1] is None:
        return _next_s(of_day_s, DAY_S, start_s, after_s)
    day = match[1].title()
    known = {name: number for number, names in enumerate(zip(DAYS, _LONG)) for name in names}
    if day not in known:
        raise ValueError(f"no weekday {shown(match[1])}; {did_you_mean(day, known)}")
    return _next_s(known[day] * DAY_S + of_day_s, WEEK_S, start_s, after_s)


_LONG = ("Monday", "Tuesday", "Wednesday", "Thursday", "Friday", "Saturday", "Sunday")


def _next_s(clock_s: float, every_s: float, start_s: float, after_s: float) -> float:
    """The first moment from ``after_s`` on at which a clock of that period shows ``clock_s``."""
    return after_s + (clock_s - start_s - after_s) % every_s
