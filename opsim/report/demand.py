"""Whether the floor keeps up with what is asked of it, so that no station but demand sets the pace."""

from __future__ import annotations

import numpy as np

from opsim.kpi.values import in_window
from opsim.log import CREATE, LEAVING_KINDS
from opsim.plan.loads.rates import flows_of
from opsim.report.material import Material
from opsim.report.sentence import find

ASKED, LEFT, LOST = 0.9, 0.95, 0.03
"""Shares: of what the sources would release, that came in; of what came in, that left; of what arrived, turned away."""


def keeps_up(material: Material) -> bool:
    """Whether jobs come in by themselves, all that arrive are let in, and as many leave; in the first replication.

    False where the floor decides what comes in, and where no rows are kept to see it by.
    """
    plan, log, lost = material.plan, material.log, find(material.rows("lost_share"), "lost_share")
    flows = flows_of(plan)
    if log is None or flows.saturated or flows.per_h <= 0 or (lost is not None and lost["mean"] > LOST):
        return False
    low_s, high_s = plan.window_s
    came = (log["kind"] == CREATE) & in_window(log["end_s"], plan)
    left = np.isin(log["kind"], list(LEAVING_KINDS)) & in_window(log["end_s"], plan)
    asked = flows.per_h * (high_s - low_s) / 3600
    return bool(came.sum() >= ASKED * asked and left.sum() >= LEFT * came.sum())
