"""What hours may do to a floor, by shifts, breaks, rotations, lines and crews: warnings of ``opsim check``."""

from __future__ import annotations

from opsim.plan.hours import Hours
from opsim.plan.loads.bottleneck import Loads, loads_of
from opsim.plan.plan import Plan
from opsim.plan.warnings.hours import empty_posts, left_under_way, starving_breaks
from opsim.plan.warnings.staffing import in_lines, standing_lines, too_long_for_the_takt, unmanned

__all__ = ["hour_risks"]


def hour_risks(plan: Plan, loads: Loads | None = None) -> list[str]:
    """Every warning in a sentence."""
    loads = loads_of(plan) if loads is None else loads
    hours = Hours(plan)
    ranks = {station.name: rank for rank, station in enumerate(plan.stations)}
    by_hand = {ranks[load.skill] for load in loads.skills}
    return [
        *unmanned(plan, hours, by_hand - in_lines(plan)),
        *standing_lines(plan, hours, by_hand),
        *too_long_for_the_takt(plan, hours, loads.flows),
        *left_under_way(plan, hours, by_hand),
        *starving_breaks(plan, hours, loads, by_hand),
        *empty_posts(plan, hours, by_hand),
    ]
