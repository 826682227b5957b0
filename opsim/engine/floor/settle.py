"""What happens to events, and one settle step an instant that does everything else."""

from __future__ import annotations

from opsim.engine.endless import MOST_ROUNDS
from opsim.engine.floor.admission import admit, release_saturated, turn_away
from opsim.engine.floor.allocation import send_workers
from opsim.engine.floor.columns import flush_all
from opsim.engine.floor.machine import here, inlined, step
from opsim.engine.floor.parts.heap import forget_event, is_last_of_instant
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.rows import log_job, log_worker
from opsim.engine.floor.parts.state import Floor
from opsim.engine.floor.parts.stretches import NOBODYS, wake
from opsim.engine.floor.release import open_source, source_happens
from opsim.engine.rules import ARRIVAL

ENDLESS, NO_LUCK = 1, 2
"""Why a run has to end: a loop of zero delays; numbers that could not be drawn."""


@step
def happen(floor: Floor, event: Event) -> None:
    """Something has come to its time: a report, where it still means something."""
    if event.line == NOBODYS or not event.alive:
        forget_event(floor, event)
    elif event.kind == ARRIVAL:
        _source_happens(floor, event)
    elif event.worker:
        if event.version != event.worker.version:
            forget_event(floor, event)
            return
        event.worker.version += 1
        floor.active = event.worker
        _report(floor, event)
        floor.active = floor.no_worker
    else:
        _report(floor, event)


@step
def report(floor: Floor, event: Event) -> None:
    """Something happened now. It is applied in settle, in the order of (kind, natural rank, job number)."""
    if not floor.settle_pending and is_last_of_instant(floor):
        floor.now = floor.env_now  # the instant has no other event, so this is its end already
        floor.alone = 1
        event.line(floor, event)
        floor.alone = 0
        forget_event(floor, event)
        _dispatch(floor)
    else:
        floor.reports.append(event)
        wake(floor)


@inlined
def _comes_before(one: Event, other: Event) -> bool:
    if one.kind != other.kind:
        return one.kind < other.kind
    if one.rank != other.rank:
        return one.rank < other.rank
    return one.number < other.number


@step
def settle(floor: Floor) -> None:
    """Apply the reports of the instant in their order, then dispatch."""
    floor.settle_pending = 0
    floor.now = floor.env_now
    reports = floor.reports
    for i in range(1, len(reports)):
        one, at = reports[i], i
        while at > 0 and _comes_before(one, reports[at - 1]):
            reports[at] = reports[at - 1]
            at -= 1
        reports[at] = one
    for hook in reports:
        hook.line(floor, hook)
        forget_event(floor, hook)
    reports.clear()
    dispatch(floor)


@step
def dispatch(floor: Floor) -> None:
    """Move jobs, give out tools, parts, vehicles and what else they wait for, send workers, until nothing changes."""
    for _ in range(MOST_ROUNDS):
        if floor.stirred:
            _admit(floor)
        if floor.saturated:
            release_saturated(floor)
        if floor.losing:
            turn_away(floor)
        changed = False
        for given_out in floor.dispatchers:
            if given_out.line(floor, given_out.subject):
                changed = True
        if floor.free:
            _send_workers(floor)
        if not floor.stirred and not changed:
            return
        if floor.error:
            return
    floor.error = ENDLESS


@step
def start(floor: Floor) -> None:
    """What blocks do at the start of a run, in the order in which they were installed."""
    for begun in floor.starts:
        _ = begun.line(floor, begun.subject)
    wake(floor)
    for rank in range(floor.n_sources):
        open_source(floor, floor.sources[rank])


@step
def close(floor: Floor) -> None:
    """Rows that are open at the horizon are written as they are there."""
    closing = floor.closing
    floor.now = floor.horizon_s
    for hook in closing:
        _ = hook.line(floor, hook.subject)
    for rank in range(floor.n_workers):
        log_worker(floor, floor.workers[rank])
    job = floor.first_job
    while job:
        log_job(floor, job)
        job = job.next_on_floor
    flush_all(floor)


_report, _admit, _send_workers = here(report), here(admit), here(send_workers)
_source_happens, _dispatch = here(source_happens), here(dispatch)
