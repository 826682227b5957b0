"""A time within a run, as people say it: "Tue 10:15:30" on the week's clock, or so long since the run began."""

from __future__ import annotations

from opsim.clock import DAY_S, DAYS
from opsim.week_clock import clock_words, moment_s


def run_s(text: str, start_s: float, horizon_s: float) -> float:
    """Seconds on the run's clock: the first such time of the run; "90 min" is since the run began.

    Raises ValueError where it cannot be read, or lies outside the run.
    """
    from opsim.problems import shown

    try:
        found_s = moment_s(text, start_s)
    except ValueError as error:
        raise ValueError(f"--at: {error}") from None
    if not 0 <= found_s < horizon_s:
        first, last = clock_words(0.0, start_s), clock_words(horizon_s, start_s)
        raise ValueError(f"--at: found {shown(text)}, outside the run; expected a time from {first} to before {last}")
    return found_s


def start_of(start: str) -> float:
    """When a run begins, as its summary says it ("Mon 06:00"), in seconds after Monday 00:00."""
    day, clock = start.split()
    hours, minutes = clock.split(":")
    return DAYS.index(day) * DAY_S + int(hours) * 3600.0 + int(minutes) * 60.0
