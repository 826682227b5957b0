"""What follows when a stretch of time is over: arrivals of walks, ends of performances, automatic ends.

What happens to events, and one settle step an instant that does everything else.
"""

from __future__ import annotations

from opsim.engine.endless import MOST_ROUNDS
from opsim.engine.floor.event_list import forget_event, is_last_of_instant, wake
from opsim.engine.floor.floor_state import ENDLESS, Floor
from opsim.engine.floor.flow import operation_done, put_down
from opsim.engine.floor.log_rows import flush_all, log_job, log_worker
from opsim.engine.floor.machine import NOTHING, here, inlined, step
from opsim.engine.floor.state import Event, Job, Worker
from opsim.engine.rules import ARRIVAL
from opsim.log import AFTER, BLOCKED, SETUP, TRANSPORT, WALK
from opsim.subjects.people.allocation import send_workers
from opsim.subjects.people.worker import ended, hold, set_free, task_done
from opsim.subjects.release.sources import open_source, source_happens
from opsim.subjects.stations.buffers import admit, release_saturated, turn_away
from opsim.subjects.stations.station import next_task, perform, proceed


@step
def stretch_done(floor: Floor, event: Event) -> None:
    """A worker's stretch of time is over."""
    worker = event.worker
    job = worker.job
    if not job:
        set_free(floor, worker)
    elif job.kind == TRANSPORT:
        put_down(floor, job, worker)
    elif worker.kind == WALK:
        log_worker(floor, worker)
        worker.since_s = floor.now
        perform(floor, job, worker)
    else:
        acteds = job.station.acteds
        for hook in acteds:
            if hook.line(floor, hook.subject, job, worker):
                return
        _performed(floor, job, worker)


@step
def performed(floor: Floor, job: Job, worker: Worker) -> None:
    """A worker has come to the end of a performance."""
    ended(floor, job)
    if job.kind == SETUP:
        job.setup_task = -1
        proceed(floor, job, worker)
    elif task_done(job):
        _operation_over(floor, job, worker)
    else:
        next_task(floor, job, worker)


@step
def operation_over(floor: Floor, job: Job, worker: Worker) -> None:
    """The operation is done, by a worker who stays with the job where it is carried, or held, and has to wait."""
    may_stay = job.plan.carried or floor.held_when_blocked
    floor.at_once = floor.alone and not may_stay
    floor.done = job
    _operation_done(floor, job)
    floor.at_once = 0
    if may_stay and floor.done is job and _stays(floor, job):
        hold(floor, worker, job)
    else:
        set_free(floor, worker)


@step
def _stays(floor: Floor, job: Job) -> bool:
    """Whether the job waits at the station for room downstream: on its server, or put away with who will carry it."""
    if floor.has_legs and not floor.held_when_blocked and is_fetched(floor, job):
        return False
    return job.kind == BLOCKED or (job.plan.carried == 1 and job.cause == AFTER)


@step
def is_fetched(floor: Floor, job: Job) -> bool:
    """Whether a vehicle comes for it, whichever of its next stations it goes to."""
    if not floor.has_legs or job.station.rank < 0:
        return False
    gate = job.gate
    for i in range(gate.n_stations):
        if not floor.legs[job.station.rank * floor.n_stations + gate.stations[i].rank]:
            return False
    return True


@step
def automatic_done(floor: Floor, event: Event) -> None:
    """An automatic run is over."""
    job = event.job
    job.over = NOTHING
    ended(floor, job)
    if job.kind == SETUP:
        job.setup_task = -1
        proceed(floor, job, floor.no_worker)
    elif task_done(job):
        floor.at_once = floor.alone
        _operation_done(floor, job)
        floor.at_once = 0
    else:
        next_task(floor, job, floor.no_worker)


_performed, _operation_over, _operation_done = here(performed), here(operation_over), here(operation_done)


@step
def happen(floor: Floor, event: Event) -> None:
    """Something has come to its time: a report, where it still means something."""
    if not event.alive:
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
        if floor.saturated and not floor.entries_full:
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
