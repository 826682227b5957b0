"""Rounds of workers who patrol."""

from __future__ import annotations

from opsim.engine.floor.machine import inlined
from opsim.engine.floor.parts.state import Station, Worker


@inlined
def on_round(worker: Worker, station: Station) -> bool:
    """Whether this is the station of his round where the worker stands: the only one a patrolling worker serves, and
    none any more once he has served there as long as he shall.
    """
    at = worker.round
    return at >= 0 and worker.patrol[at] == station.rank and worker.place == station.place and not worker.served
