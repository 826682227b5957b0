"""Figures of conveyors."""

from collections.abc import Iterator

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.resources import any_s
from opsim.kpi.window import inside_s, window_length_s
from opsim.log import BLOCKED, JOB_KINDS, EventLog
from opsim.plan import Plan
from opsim.plan.stations import CONVEYOR


def conveyors(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each conveyor: on_conveyor, jobs on it, averaged over the window; conveyor_blocked, the share of the window in
    which the job at its end finds no room.
    """
    for rank, belt in enumerate(plan.stations):
        if belt.kind != CONVEYOR:
            continue
        here = np.flatnonzero((log["station"] == rank) & (log["job"] >= 0) & np.isin(log["kind"], JOB_KINDS))
        blocked = here[log["kind"][here] == BLOCKED]
        length_s = window_length_s(plan)
        yield figure("on_conveyor", belt.name, "", inside_s(log, here, plan).sum() / length_s)
        yield figure("conveyor_blocked", belt.name, "", any_s(log, plan, blocked) / length_s)
