"""Times of a run as times of the calendar: run clock + when it began in its week + a Monday."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, timedelta

import numpy as np

MONDAY = date(2026, 1, 5)
"""The Monday that a run's week begins with, where nobody says another."""
FIRST = "1970-01-01T00:00:00.000000Z"
"""When OCEL 2.0 says that something holds from the beginning on."""


@dataclass(frozen=True)
class RunClock:
    """monday : the day at whose 00:00 (UTC) the week of the run begins; start_s : run clock 0, seconds after that."""

    start_s: float
    monday: date = MONDAY

    def texts(self, times_s: np.ndarray) -> list[str]:
        """(n,) ISO 8601 times, UTC, to the microsecond: "2026-01-05T06:00:00.000000Z"."""
        began = np.datetime64(self.monday, "us") + np.timedelta64(round(self.start_s * 1e6), "us")
        passed = np.rint(np.asarray(times_s, dtype=float) * 1e6).astype(np.int64)
        # NOTE: each time is often there twice and more, as rows follow each other; to write one costs 0.5 us
        moments, which = np.unique(passed, return_inverse=True)
        written = np.datetime_as_string(began + moments.astype("timedelta64[us]"), unit="us")
        return np.char.add(written, "Z")[which].tolist() if moments.size else []


def monday_of(text: str) -> date:
    """A date as "2026-01-05". Raises ValueError where it is none, or no Monday."""
    try:
        day = date.fromisoformat(text)
    except ValueError:
        raise ValueError(f"--date {text!r}: found no date, expected one such as {MONDAY}") from None
    if day.weekday():
        before = day - timedelta(days=day.weekday())
        raise ValueError(f"--date {text}: found a {day:%A}, expected a Monday, where the week begins, such as {before}")
    return day
