"""Shift arithmetic, exact, and how many of a shift are absent, by the binomial."""

from math import comb

from known_answers.case import Case

_SHIFT = "shift arithmetic, one worker, 7-minute jobs, never starved"
WORKERS, MISSES = 8, 0.1


def absent_share(missing: int) -> float:
    """The share of shifts that so many of eight miss, each a tenth of his."""
    return comb(WORKERS, missing) * MISSES**missing * (1 - MISSES) ** (WORKERS - missing)


CASES = (
    Case("shift", "base", "jobs_finished", (_SHIFT, "resume")),
    *(
        Case("absence", "base", figure, expected, most_half_width=0.05, few=60)
        for figure, expected in (
            ("absent_at_once", WORKERS * MISSES),
            ("shifts_missed_by_none", absent_share(0)),
            ("shifts_missed_by_two", absent_share(2)),
        )
    ),
)
