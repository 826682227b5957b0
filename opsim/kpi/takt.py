"""The rhythm that demand asks for, and how often the floor keeps it."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.open_hours import elapsed_s, is_in
from opsim.kpi.values import in_window, mean
from opsim.log import FINISH, EventLog
from opsim.plan import Plan
from opsim.plan.hours.scheduled import has_hours, scheduled
from opsim.plan.hours.spans import Spans, total_s

_SLACK = 1 + 1e-9
"""A gap of exactly takt keeps it, whatever the last digit of a sum says."""


def takt(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Takt = open time / demand, and the share of good jobs that follow the one before within takt.

    Demand is what the sources release by time or by order, in the whole run; where only the floor decides (saturated
    sources, a base stock) these figures are absent. Where hours are kept, both count the hours for which the floor is
    scheduled to be open (``opsim.plan.hours.scheduled``): they are what there is to meet the demand in, and a gap
    between two jobs is the open time between them. What leaves outside of these hours, in overtime or after closing,
    follows no rhythm: it is not counted. The job before may have left ahead of the window.
    Source: Rother & Shook 1999, Learning to See, Lean Enterprise Institute (takt time).
    """
    open_s = scheduled(plan) if has_hours(plan) else None
    takt_s = _takt_s(plan, open_s)
    if takt_s is None:
        return
    yield Figure("takt_s", "", "", "s", takt_s)
    yield Figure("takt_attainment", "", "", "share", mean(_gaps_s(log, plan, open_s) <= takt_s * _SLACK))


def _gaps_s(log: EventLog, plan: Plan, open_s: Spans | None) -> np.ndarray:
    """(n,) seconds from the job before to each that leaves in the window, and in open hours where there are some."""
    finish_s = log["end_s"][log["kind"] == FINISH]
    counted = in_window(finish_s[1:], plan)
    if open_s is None:
        return np.diff(finish_s)[counted]
    return np.diff(elapsed_s(open_s, finish_s))[counted & is_in(open_s, finish_s[1:])]


def _takt_s(plan: Plan, open_s: Spans | None) -> float | None:
    """Open seconds for each job that sources release by themselves; None where they release none."""
    if open_s is None:
        every_s = [found for source in plan.sources if (found := source.job_every_s(plan.horizon_s)) is not None]
        return every_s[0] if len(every_s) == 1 else 1 / sum(1 / one for one in every_s) if every_s else None
    per_s = [found for source in plan.sources if (found := source.jobs_per_s(plan.horizon_s))]
    return (total_s(open_s) / plan.horizon_s / sum(per_s) or np.nan) if per_s else None
