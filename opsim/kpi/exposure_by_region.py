"""From which region of the body the minutes at a high score come."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.ergonomics.shift.regions import LEVELS, REGIONS, Regions
from opsim.kpi.duty import present_s
from opsim.kpi.figure import Figure
from opsim.kpi.values import SECONDS_PER_HOUR
from opsim.log import EventLog
from opsim.plan import Plan


def exposure_by_region(regions: Regions, log: EventLog, plan: Plan) -> Iterator[Figure]:
    """exposure_by_region: measured minutes at RULA 5 (part rula_from_5) or 7, in an hour of all workers' time, dealt
    out to trunk, neck, arms, wrists and legs, to the load and to ``time`` (what repeating or holding adds) by the
    points of the score that each brings in. They sum to the minutes there are.
    """
    hours = float(present_s(log, plan).sum()) / SECONDS_PER_HOUR
    minutes = regions.seconds.sum(axis=0) / 60.0
    for row, region in enumerate(REGIONS):
        for column, level in enumerate(LEVELS):
            value = float(minutes[row, column]) / hours if hours else float("nan")
            yield Figure("exposure_by_region", region, f"rula_from_{level}", "min/h", value)
