"""How much of its time a station is up when it always works: breakdowns and planned maintenance."""

from __future__ import annotations

from opsim.plan.failures import BUSY, CLOCK, BreakdownPlan
from opsim.plan.plan import Plan


def down_per_up(plan: Plan, stop: BreakdownPlan, visit_s: float) -> float:
    """Seconds of repair for each second that the station is up and at work; waiting for a repair team not counted.

    visit_s : time of a visit on a server, for breakdowns that count cycles.
    """
    repair_s, every = plan.tasks[stop.task].mean_s(), stop.every.mean_duration_s()
    if stop.by in (CLOCK, BUSY):
        return repair_s / every
    servers = plan.stations[stop.station].servers
    return repair_s * servers / (every * visit_s) if visit_s > 0 else 0.0


def up_share(plan: Plan, station: int, visit_s: float) -> float:
    """Share of the time that a station can work, from 0 to 1."""
    down = sum(down_per_up(plan, stop, visit_s) for stop in plan.breakdowns if stop.station == station)
    planned = sum(plan.tasks[stop.task].mean_s() / stop.every_s for stop in plan.maintenance if stop.station == station)
    return max(0.0, 1.0 - planned) / (1.0 + down)
