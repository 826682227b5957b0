"""How far people walk."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.log import WALK, EventLog
from opsim.plan import Plan


def walked(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Metres each worker walks in the window; a walk across its edge counts for the share inside."""
    walks = log.of(WALK)
    distance_m = np.array(plan.distance_m)[walks["place_from"], walks["place_to"]]
    inside = walks.clipped_s(*plan.window_s) / walks.duration_s
    metres = np.bincount(walks["worker"], weights=distance_m * inside, minlength=len(plan.workers))
    for rank, worker in enumerate(plan.workers):
        yield Figure("walked_m", worker.name, "", "m", metres[rank])
