"""Which objects each row of a log tells of, and what they are to it."""

from __future__ import annotations

from collections.abc import Iterator

from opsim import log as kinds
from opsim.export.object_ids import ObjectIds
from opsim.export.object_log import Related
from opsim.log import EventLog

AT, TOWARDS, BY, JOB, INTO, MADE_FROM = "at", "towards", "by", "job", "into", "made from"
VEHICLE, TOOL, OF_ORDER = "vehicle", "tool", "of order"
"""Qualifiers: station it is at or goes to, worker it is done by, job, jobs it becomes or came from, vehicle, tool."""


def related(log: EventLog, ids: ObjectIds, rows: list[int]) -> Iterator[Related]:
    """(id, qualifier) of the objects of each of some rows. The station of a paced line is its first.

    A walk to a job, or a wait beside one, is the worker's and not the job's, which at that time is held or in a queue:
    so the events of a job follow one another.
    """
    columns = (log[name][rows].tolist() for name in ("kind", "worker", "station", "job", "k"))
    for kind, worker, station, job, k in zip(*columns):
        found: list[tuple[str, str]] = []
        if job >= 0 and kind not in BESIDE:
            found.append((ids.job(job), JOB))
        if worker >= 0:
            found.append((ids.workers[worker], BY))
        if station >= 0:
            moves = kind in (kinds.WALK, kinds.TRANSPORT)
            found.append((ids.stations[station], TOWARDS if moves else AT))
        if kind in _OTHERS and k >= 0:
            found.append(_OTHERS[kind](ids, k))
        elif kind == kinds.TRANSPORT and k >= 0 and job < 0 and worker < 0:
            found.append((ids.vehicles[k], VEHICLE))
        if kind == kinds.CREATE and (order := ids.order(job)) is not None:
            found.append((order, OF_ORDER))
        yield tuple(dict.fromkeys(found))


BESIDE = (kinds.WALK, kinds.WAIT)
"""Kinds in which a worker is on his way to a job, or stands beside it: it is an attribute of theirs."""
_OTHERS = {
    kinds.TOOL: lambda ids, k: (ids.tools[k], TOOL),
    kinds.JOIN: lambda ids, k: (ids.job(k), INTO),
    kinds.CREATE: lambda ids, k: (ids.job(k), MADE_FROM),
}
"""Kinds whose k is the number of another object."""
