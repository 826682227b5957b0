"""An EventLog in a notebook: how many rows of which kind, and what the workers did."""

from __future__ import annotations

import numpy as np

from opsim.log import KINDS, WORKER_KINDS, EventLog
from opsim.report.palette import OTHER, STATES
from opsim.shown.html import MOST_ROWS, count, duration, sentence, table
from opsim.shown.pictures import share_bars


def log_html(log: EventLog) -> str:
    """A sentence, the workers' states as bars, and a table by kind."""
    words = f"{count(len(log), 'row')} of replication {log.replication}, {duration(log.horizon_s)}."
    rows = [
        (KINDS[kind], int(np.sum(log["kind"] == kind)), float(log.duration_s[log["kind"] == kind].sum()) / 3600)
        for kind in np.unique(log["kind"]).tolist()
    ]
    return sentence("EventLog:", words) + _workers(log) + table(("kind", "rows", "hours"), rows)


def _workers(log: EventLog) -> str:
    bars: dict[str, dict[str, float]] = {}
    for rank in np.unique(log["worker"]).tolist()[: MOST_ROWS + 1]:
        if rank < 0 or not log.horizon_s:
            continue
        own = log.where((log["worker"] == rank) & np.isin(log["kind"], WORKER_KINDS))
        spent_s = np.bincount(own["kind"], weights=own.duration_s, minlength=len(KINDS))
        bars[log.names["worker"][rank]] = {KINDS[kind]: float(spent_s[kind]) / log.horizon_s for kind in WORKER_KINDS}
    colours = {KINDS[kind]: STATES.get(KINDS[kind], OTHER)[0] for kind in WORKER_KINDS}
    return share_bars(bars, colours) if bars else ""
