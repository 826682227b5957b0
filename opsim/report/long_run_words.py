"""The figures of a long run as words: means, batches, times, and what is doubted in a cell."""

from __future__ import annotations

import math
from typing import Any

from opsim.report.words import plus_minus, scale_of

NAMES = {
    "throughput_per_h": "Jobs finished",
    "time_in_system_s": "Time in system",
    "work_in_progress": "Jobs inside",
    "jobs_waiting": "Jobs waiting",
    "people_at_work": "People at work",
}


def mean_words(one: Any) -> str:
    """``48.2 ± 1.0 per hour``; jobs and people are not said again behind their number."""
    unit = "" if one.unit in ("jobs", "people") else one.unit
    return plus_minus({"mean": one.batches.mean, "half_width": one.batches.half_width, "unit": unit})


def batch_words(one: Any) -> str:
    """``40 batches of 4.7 h`` or ``10 batches of 916 jobs``."""
    return f"{one.batches.n} batches of {length_words(one)}"


def length_words(one: Any) -> str:
    """How long a batch is, in time or in jobs."""
    if math.isfinite(one.batch_jobs):
        return f"{one.batch_jobs:,.0f} jobs"
    return time_words(one.batch_s)


def time_words(seconds: float) -> str:
    """A time with two digits, in days where it is long: ``4.7 h``, ``12 days``."""
    if seconds >= 3 * 86_400:
        return f"{seconds / 86_400:,.3g} days"
    factor, unit = scale_of("s", seconds)
    return f"{seconds * factor:.2g} {unit}" if seconds * factor < 10 else f"{seconds * factor:.0f} {unit}"


def reasons(one: Any) -> str:
    """In a cell: what speaks against a figure, or ``ok``."""
    words = {
        "unstable": "grows for good",
        "growing": "keeps growing",
        "too_short": "too short",
        "autocorrelated": "batches alike",
        "start_left": "start shows",
        "few_events": "few jobs",
    }
    if one.batches is None:
        return "too few values"
    return ", ".join(words[flag.code] for flag in one.flags) or "ok"
