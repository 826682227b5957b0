"""The law of rooms: nothing stands where there is no place for it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from opsim.laws.jobs import Stays, peak
from opsim.log import AFTER, BLOCKED, HELD, PICKUP, QUEUE, SETUP, WORK, EventLog
from opsim.plan import Plan
from opsim.subjects.material.plan import jobs_on_a_server
from opsim.subjects.stations.plan import STATION

ON_SERVER = (WORK, SETUP, BLOCKED, HELD)


def rooms(_log: EventLog, plan: Plan, stays: Stays) -> Iterator[str]:
    """No more jobs at a point than fit there, on its servers, in its buffers, and with those on their way to it.

    A job that comes back to its own station may wait in its buffer although others keep the server that they shared.
    """
    for rank, place in enumerate(plan.stations):
        here = stays.rows.where(stays.rows["station"] == rank)
        queued = here["kind"] == QUEUE
        done = queued & np.isin(here["cause"], (AFTER, PICKUP))
        together = jobs_on_a_server(plan, rank) if place.kind == STATION else 1
        servers = place.servers * together
        rules = []
        if place.kind == STATION:
            rules = [
                (np.isin(here["kind"], ON_SERVER), servers, "servers"),
                (queued & ~done & (together == 1), place.buffer, "places in its buffer"),
                (done, place.buffer_after, "places in the buffer after it"),
            ]
        for mask, most, what in [*rules, (~done, servers + place.buffer, "places")]:
            found = peak(here.where(mask))
            if found > most:
                yield f"{place.kind} {place.name}: {found} jobs at once on {most:g} {what}"
