"""Times and names as a sentence says them."""

from __future__ import annotations

from collections.abc import Iterable

from opsim.names import enumerated
from opsim.plan.hours import Hours
from opsim.plan.hours.spans import Spans, both, total_s
from opsim.plan.plan import Plan

SHORT_S = 60.0
"""What is shorter is not worth a word."""


def lasting(seconds: float) -> str:
    """``45 s``, ``30 min``, ``7.5 h``."""
    if seconds < 120:
        return f"{seconds:.3g} s"
    return f"{seconds / 60:.3g} min" if seconds < 5400 else f"{seconds / 3600:.4g} h"


def on_shifts(plan: Plan, hours: Hours, when: Spans) -> str:
    """`` on shift late``, `` on shifts early and late``: those on which people are at some times; empty where none."""
    ranks = [rank for rank in range(len(plan.shifts)) if total_s(both(hours.during(rank), when)) >= SHORT_S]
    names = [plan.shifts[rank].name for rank in ranks]
    return f" on shift{'s' if len(names) > 1 else ''} {enumerated(names)}" if names else ""


def station_names(plan: Plan, ranks: Iterable[int]) -> str:
    """The names of stations, in natural order."""
    return enumerated([plan.stations[rank].name for rank in sorted(ranks)])


def worker_names(plan: Plan, ranks: Iterable[int]) -> str:
    """The names of workers, in natural order."""
    return enumerated([plan.workers[rank].name for rank in sorted(ranks)])
