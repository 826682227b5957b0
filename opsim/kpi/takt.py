"""The rhythm that demand asks for, and how often the floor keeps it."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import in_window, mean
from opsim.log import FINISH, EventLog
from opsim.plan import Plan


def takt(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Takt = open time / demand, and the share of good jobs that follow the one before within takt.

    Demand is what is released; a saturated source has none, and these figures are then absent. No calendar closes the
    floor yet, so takt is the mean time between two releases. The job before may have left ahead of the window.
    Source: Rother & Shook 1999, Learning to See, Lean Enterprise Institute (takt time).
    """
    if plan.release.every_s <= 0:
        return
    finish_s = log["end_s"][log["kind"] == FINISH]
    gap_s = np.diff(finish_s)[in_window(finish_s[1:], plan)]
    yield Figure("takt_s", "", "", "s", plan.release.every_s)
    yield Figure("takt_attainment", "", "", "share", mean(gap_s <= plan.release.every_s))
