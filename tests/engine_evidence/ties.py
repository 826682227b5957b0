"""Contested ties of a log: instants at which nothing but rank, number or kind of report decided who came first."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

from opsim import log as kinds
from opsim.engine.rules import BY_DUE_DATE
from opsim.log import EventLog
from opsim.plan import Plan
from opsim.subjects.people.plan import WorkerPlan

BY_TIME = {"poisson", "renewal", "schedule"}
WAITS = (kinds.QUEUE, kinds.HELD, kinds.BLOCKED)
FOR_SOMEBODY = (kinds.AWAY, kinds.BEHIND)
"""Causes by which a job waits for one person, or for the job ahead: what two of them wait for is not the same."""
IS_DONE = 1.0


class Row(NamedTuple):
    """A row of a log as plain numbers."""

    kind: int
    start_s: float
    end_s: float
    worker: int
    station: int
    place: int
    source: int
    job: int
    product: int
    operation: int
    cause: int
    done: float


def contested_ties(plan: Plan, log: EventLog) -> int:
    """How many instants of a log had one of these, the first and the last instant of a run left out:

    alike   : of two jobs of one product that waited for the same since the same instant (the same state, cause, station
              and operation, so that every rule gives both the same key up to their numbers) one went on, the other not
    spare   : of two workers who stood free at one place, with the same rating, speed, zone and duties, one was sent to
              a station and the other one stayed
    reports : reports of two kinds at one station: something was done there just when the station broke down, was
              repaired, opened or closed, when its worker's break or end of shift was planned, or when a job came from
              outside
    """
    rows = rows_of(log)
    found = {*alike(plan, rows), *spare(plan, rows), *reports(plan, rows)}
    return len([time_s for time_s in found if 0.0 < time_s < plan.horizon_s])


def rows_of(log: EventLog) -> list[Row]:
    """All rows in the order of the log."""
    columns = ("kind", "start_s", "end_s", "worker", "station", "place_from", "source", "job", "product", "operation")
    return [Row(*one) for one in zip(*(log[name].tolist() for name in (*columns, "cause", "progress_to")))]


def alike(plan: Plan, rows: list[Row]) -> set[float]:
    """When one of several jobs that waited alike went on before another one."""
    created_s = {row.job: row.start_s for row in rows if row.kind == kinds.CREATE}
    ordered = {rank for rank, source in enumerate(plan.sources) if source.kind == "schedule"}
    dated = {queue.station for queue in plan.queues if queue.rule in BY_DUE_DATE}
    together: dict[tuple, set[float]] = defaultdict(set)
    for row in _waits(rows):
        if row.source in ordered or row.cause in FOR_SOMEBODY or (row.kind == kinds.BLOCKED and _may_part(plan, row)):
            continue
        since_s = created_s.get(row.job) if row.station in dated else None
        what = (row.kind, row.cause, row.station, row.product, row.operation, row.start_s, since_s)
        together[what].add(row.end_s)
    return {end_s for ends_s in together.values() for end_s in ends_s if end_s < max(ends_s)}


def _waits(rows: list[Row]) -> Iterator[Row]:
    """Stretches of waiting; in a queue the whole of it, whatever it is for, with the cause that it began with."""
    queued: dict[int, Row] = {}
    for row in sorted((row for row in rows if row.job >= 0 and row.worker < 0), key=lambda row: row.start_s):
        before = queued.get(row.job)
        if row.kind == kinds.QUEUE and before is not None and _goes_on(before, row):
            queued[row.job] = before._replace(end_s=row.end_s)
        elif row.kind == kinds.QUEUE:
            if before is not None:
                yield before
            queued[row.job] = row
        elif row.kind in WAITS:
            yield row
    yield from queued.values()


def _goes_on(before: Row, row: Row) -> bool:
    return before.end_s == row.start_s and before.station == row.station


def _may_part(plan: Plan, row: Row) -> bool:
    """Whether jobs of a product that are blocked at a station may want to go different ways."""
    drawn = any(len(ways) > 1 for ways in (plan.products[row.product].start, *plan.products[row.product].onward))
    return drawn or any(one.station == row.station and one.inspects for one in plan.quality)


def spare(plan: Plan, rows: list[Row]) -> set[float]:
    """When one of several free workers who are all the same to a station was sent there."""
    if plan.idle == "patrol" or plan.rule == "least_exposed":
        return set()
    plain = _plain_workers(plan)
    idle = [row for row in rows if row.kind == kinds.WAIT and row.cause == kinds.IDLE and row.worker in plain]
    until = {(row.worker, row.end_s): row for row in idle}
    found = set()
    for row in rows:
        stood = until.get((row.worker, row.start_s))
        if stood is None or row.job < 0 or row.kind not in (kinds.WORK, kinds.SETUP, kinds.WALK):
            continue
        others = (one for one in idle if one.start_s <= row.start_s < one.end_s and one.place == stood.place)
        if any(_same(plan, one.worker, row.worker, row.station) for one in others if one.worker != row.worker):
            found.add(row.start_s)
    return found


def _plain_workers(plan: Plan) -> set[int]:
    """Those whom nothing but skills, zones and floating sends here or there."""
    bound = {worker for crew in plan.crews for worker in crew.workers}
    bound |= {worker for turns in plan.rotations for worker in turns.workers}
    bound |= {worker for line in plan.lines for worker in line.floaters}
    return set(range(len(plan.workers))) - bound


def _same(plan: Plan, one: int, other: int, station: int) -> bool:
    """Whether two workers who stand at one place are the same to a station."""
    a, b = plan.workers[one], plan.workers[other]
    zones = [not worker.zone or station in worker.zone for worker in (a, b)]
    return (
        (a.rating[station], a.walk_m_per_s, a.floater, a.duties)
        == (b.rating[station], b.walk_m_per_s, b.floater, b.duties)
        and zones[0] == zones[1]
        and a.rating[station] > 0
    )


def reports(plan: Plan, rows: list[Row]) -> set[float]:
    """When something was done at a station just as something of another kind happened there."""
    done, other = set(), set()
    timed = {rank for rank, source in enumerate(plan.sources) if source.kind in BY_TIME}
    created = {(row.job, row.start_s) for row in rows if row.kind == kinds.CREATE and row.source in timed}
    planned_s = [_planned_s(worker) for worker in plan.workers]
    for row in rows:
        if row.kind in (kinds.WORK, kinds.SETUP) and row.done == IS_DONE:
            done.add((row.station, row.end_s))
            if row.worker >= 0 and row.end_s in planned_s[row.worker]:
                other.add((row.station, row.end_s))
        if row.kind in kinds.STATION_KINDS and row.worker < 0 and row.job < 0:
            other |= {(row.station, row.start_s), (row.station, row.end_s)}
        if (row.job, row.start_s) in created and row.station >= 0:
            other.add((row.station, row.start_s))
    return {time_s for _, time_s in done & other}


def _planned_s(worker: WorkerPlan) -> set[float]:
    """When somebody's breaks, meetings and shifts are planned to begin or to end."""
    spans = [(duty.start_s, duty.end_s) for duty in worker.duties or ()]
    spans += [(pause.start_s, pause.end_s) for duty in worker.duties or () for pause in duty.pauses]
    return {time_s for span in spans for time_s in span}
