"""The rhythm that demand asks for, and how often the floor keeps it."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import in_window, mean
from opsim.log import FINISH, EventLog
from opsim.plan import Plan


def takt(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Takt = open time / demand, and the share of good jobs that follow the one before within takt.

    Demand is what the sources release by time or by order; where only the floor decides (saturated sources, a base
    stock) these figures are absent. No calendar closes the floor yet, so takt is the mean time between two of all these
    jobs. The job before may have left ahead of the window.
    Source: Rother & Shook 1999, Learning to See, Lean Enterprise Institute (takt time).
    """
    every_s = [found for source in plan.sources if (found := source.job_every_s(plan.horizon_s)) is not None]
    if not every_s:
        return
    takt_s = every_s[0] if len(every_s) == 1 else 1 / sum(1 / one for one in every_s)
    finish_s = log["end_s"][log["kind"] == FINISH]
    gap_s = np.diff(finish_s)[in_window(finish_s[1:], plan)]
    yield Figure("takt_s", "", "", "s", takt_s)
    yield Figure("takt_attainment", "", "", "share", mean(gap_s <= takt_s))
