"""How much tools are used, and how many jobs wait for them.

The law of tools: no more are in use than there are.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.catalogue import Figure, figure
from opsim.kpi.window import inside_s, window_length_s
from opsim.laws.jobs import peak
from opsim.log import HELD, NO_TOOL, TOOL, EventLog
from opsim.plan import Plan


def tools(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Of each tool, over the window: tool_use, the share of all of them that jobs have, in use or kept for it; and of
    all together tools_waited_for, the jobs that wait for one or several, on average.
    """
    if not plan.tools:
        return
    rows, length_s = np.flatnonzero(log["kind"] == TOOL), window_length_s(plan)
    spent_s = np.bincount(log["k"][rows], weights=inside_s(log, rows, plan), minlength=len(plan.tools))
    for tool, had_s in zip(plan.tools, spent_s):
        yield figure("tool_use", tool.name, "", had_s / (tool.n * length_s))
    waiting = np.flatnonzero((log["kind"] == HELD) & (log["cause"] == NO_TOOL))
    yield figure("tools_waited_for", "", "", inside_s(log, waiting, plan).sum() / length_s)


def tools_in_use(log: EventLog, plan: Plan) -> Iterator[str]:
    if not plan.tools:
        return
    held = log.of(TOOL)
    for rank, tool in enumerate(plan.tools):
        found = peak(held.where(held["k"] == rank))
        if found > tool.n:
            yield f"tool {tool.name}: {found} in use at once of {tool.n}"
