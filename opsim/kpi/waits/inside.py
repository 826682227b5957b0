"""Jobs that were inside when a run ended: what each was doing, or waiting for; those of a queue as one."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from opsim.log import AFTER, BATCH, BLOCKED, HELD, JOB_KINDS, PREEMPTED, QUEUE, SETUP, STOCK, WORK, EventLog
from opsim.plan import Plan

SEATED = (WORK, SETUP, BLOCKED, HELD)


@dataclass(frozen=True, slots=True)
class Inside:
    """A job, or n alike ones in one queue, of which this is the one that waits longest.

    name : sorts by station, then by job; operation : that it is at, or wants next; task : that it waits with, or -1
    """

    name: str
    job: int
    n: int
    product: int
    station: int
    operation: str
    kind: int
    cause: int
    task: int
    since_s: float

    @property
    def seated(self) -> bool:
        """Whether it is on a server."""
        return self.kind in SEATED

    def waits(self, kind: int, *causes: int) -> bool:
        """Whether it is in a state for one of some causes."""
        return self.kind == kind and self.cause in causes

    def words(self, plan: Plan) -> str:
        """``job 12 (bike) at assemble``, ``3 wheels in rack``."""
        product, place = plan.products[self.product].name, plan.stations[self.station].name
        if self.waits(QUEUE, STOCK):
            return f"{self.n} of {product} in {place}"
        many = f" and {self.n - 1} more" if self.n > 1 else ""
        queue = {AFTER: "after", BATCH: "in front of", PREEMPTED: "off the server at"}.get(self.cause, "in front of")
        return f"job {self.job} ({product}{many}) {queue if self.kind == QUEUE else 'at'} {place}"


def inside_at_end(log: EventLog, plan: Plan) -> list[Inside]:
    """Who is at a point of the flow when the run ends, by station; who is still outside is not told."""
    of_jobs = np.isin(log["kind"], JOB_KINDS) & (log["job"] >= 0) & (log["station"] >= 0)
    rows = np.flatnonzero(of_jobs & (log["end_s"] == log.horizon_s))
    found: dict[tuple, Inside] = {}
    for one in _each(log, plan, rows):
        key = (one.station, one.kind, one.cause, one.product, one.operation, -1 if one.kind == QUEUE else one.job)
        before = found.get(key)
        found[key] = one if before is None else _together(before, one)
    return sorted(found.values(), key=lambda one: one.name)


def _each(log: EventLog, plan: Plan, rows: np.ndarray) -> Iterator[Inside]:
    operations = dict(enumerate(log.names["operation"]))
    columns = ("job", "product", "station", "operation", "kind", "cause", "task", "start_s")
    for job, product, station, operation, kind, cause, task, start_s in zip(*(log[c][rows].tolist() for c in columns)):
        name = f"{station:06d} {job:012d}"
        yield Inside(name, job, 1, product, station, operations.get(operation, ""), kind, cause, task, start_s)


def _together(one: Inside, other: Inside) -> Inside:
    first = min(one, other, key=lambda each: (each.since_s, each.job))
    n = one.n + other.n
    return Inside(first.name, first.job, n, *(getattr(first, field) for field in Inside.__slots__[3:]))
