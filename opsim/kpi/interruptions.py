"""How often work is broken off, and what becomes of the rest."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.kpi.figure import Figure
from opsim.kpi.values import SECONDS_PER_HOUR, in_window, window_length_s
from opsim.log import WORK, EventLog
from opsim.pieces import FATES, FINISHED, job_pieces
from opsim.plan import Plan
from opsim.plan.hours.scheduled import has_hours


def interruptions(log: EventLog, plan: Plan) -> Iterator[Figure]:
    """Performances broken off in an hour of the window, of all stations (no subject) and of each, by what became of the
    rest (``opsim.pieces.FATES``): who had begun it went on, another one did later or at once, it was begun anew, or
    nobody has gone on with it.

    Only of floors where people have shifts or stations hours, or form crews: elsewhere ``stops_per_h`` says it.
    """
    if not (has_hours(plan) or plan.crews or plan.lines):
        return
    pieces = job_pieces(log)
    broken = (pieces.fate != FINISHED) & (log["kind"][pieces.row] == WORK)
    broken &= (log["end_s"][pieces.row] < log.horizon_s) & in_window(log["end_s"][pieces.row], plan)
    rows, fates = pieces.row[broken], pieces.fate[broken]
    cells = log["station"][rows].astype(np.int64) * len(FATES) + fates
    n = np.bincount(cells, minlength=len(plan.stations) * len(FATES)).reshape(-1, len(FATES))
    hours = window_length_s(plan) / SECONDS_PER_HOUR
    yield Figure("interruptions_per_h", "", "", "1/h", n.sum() / hours)
    for name, counts in [
        ("", n.sum(axis=0)),
        *((place.name, n[r]) for r, place in enumerate(plan.stations) if place.tasks),
    ]:
        for fate, count in list(zip(FATES, counts))[1:]:
            yield Figure("interruptions_per_h", name, fate, "1/h", count / hours)
