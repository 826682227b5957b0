"""The rhythm that demand asks for, and how often the floor keeps it."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.open_hours import elapsed_s, has_hours, scheduled
from opsim.kpi.values import in_window, mean
from opsim.log import FINISH, EventLog
from opsim.plan import Plan
from opsim.plan.hours.spans import total_s


def takt(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Takt = open time / demand, and the share of good jobs that follow the one before within takt.

    Demand is what the sources release by time or by order; where only the floor decides (saturated sources, a base
    stock) these figures are absent. Time counts while the floor is scheduled to be open, between two jobs too. A source
    with hours releases in them alone. The job before may have left ahead of the window.
    Source: Rother & Shook 1999, Learning to See, Lean Enterprise Institute (takt time).
    """
    takt_s = _takt_s(plan)
    if takt_s is None:
        return
    finish_s = log["end_s"][log["kind"] == FINISH]
    worked_s = elapsed_s(scheduled(plan), finish_s) if has_hours(plan) else finish_s
    gap_s = np.diff(worked_s)[in_window(finish_s[1:], plan)]
    yield Figure("takt_s", "", "", "s", takt_s)
    yield Figure("takt_attainment", "", "", "share", mean(gap_s <= takt_s))


def _takt_s(plan: Plan) -> float | None:
    """Scheduled seconds for each job that sources release by themselves; None where they release none."""
    if not has_hours(plan):
        every_s = [found for source in plan.sources if (found := source.job_every_s(plan.horizon_s)) is not None]
        return every_s[0] if len(every_s) == 1 else 1 / sum(1 / one for one in every_s) if every_s else None
    per_s = [found for source in plan.sources if (found := source.jobs_per_s(plan.horizon_s))]
    return total_s(scheduled(plan)) / plan.horizon_s / sum(per_s) if per_s else None
