"""Shares of the time for which the floor is open, from shares of all that is counted, nights and weekends with it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from opsim.kpi.open_hours import duty_hours, open_hours, open_time_s
from opsim.kpi.values import SECONDS_PER_HOUR, window_length_s
from opsim.plan import Plan
from opsim.plan.hours.scheduled import floor_has_hours, scheduled
from opsim.plan.hours.spans import either
from opsim.report.words import is_number

ENDS = ("mean", "low", "high", "half_width")
LEAST_H = 1e-6


def open_share(plan: Plan, active: float = 0.0) -> float:
    """Of the window, for which the floor is scheduled to be open; 1 where it keeps no hours, or none lie in the window.

    active : share of the window in which something was done, overtime too; the share is never less
    """
    share = open_hours(plan) * SECONDS_PER_HOUR / window_length_s(plan) if floor_has_hours(plan) else 1.0
    return min(1.0, max(share, active)) or 1.0


def of_open(row: Mapping[str, Any], share: float) -> dict[str, Any]:
    """A row of a figure that is a share of the window, as one of the open time."""
    return {**row, **{end: row[end] / share for end in ENDS if is_number(row.get(end))}}


def staffed_h(plan: Plan) -> float:
    """Hours of the window in which the floor is scheduled to be open or somebody is meant to be there; all of them
    where there are none."""
    spans = either(scheduled(plan), *(duty_hours(plan, rank) for rank in range(len(plan.workers))))
    return open_time_s(plan, spans) / SECONDS_PER_HOUR or window_length_s(plan) / SECONDS_PER_HOUR


def with_closed(plan: Plan) -> str:
    """`` of the 48 h counted, closed ones too``, where the window has hours in which nobody is meant to be there."""
    counted_h = window_length_s(plan) / SECONDS_PER_HOUR
    return f" of the {counted_h:g} h counted, closed ones too" if staffed_h(plan) < counted_h - LEAST_H else ""
