"""How far people walk."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import inside_s
from opsim.log import WALK, EventLog
from opsim.plan import Plan
from opsim.walks import on_grid_each, ways_m


def walked(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Metres each worker walks in the window; a walk across an edge of it or cut by the horizon counts in part."""
    rows = np.flatnonzero(log["kind"] == WALK)
    worker = log["worker"][rows]
    speed = np.array([w.walk_m_per_s for w in plan.workers])[worker]
    way_m = ways_m(log, plan, rows, speed)
    whole_s = on_grid_each(way_m / speed)
    share = np.minimum(1.0, inside_s(log, rows, plan) / whole_s)
    metres = np.bincount(worker, weights=way_m * share, minlength=len(plan.workers))
    for rank, person in enumerate(plan.workers):
        yield Figure("walked_m", person.name, "", "m", metres[rank])
