"""Performances that are broken off, and stations that stand still: for breakdowns, maintenance, pre-emption.

Pre-emption: a job of higher priority takes the server of a lower one.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import be_unseated, give_up_place
from opsim.engine.floor.log_rows import job_now, log_worker, progress
from opsim.engine.floor.machine import NOTHING, cast, inlined, step, struct
from opsim.engine.floor.state import GOES_ON, Job, Station, Worker
from opsim.log import AWAY, HELD, NO_WORKER, PREEMPTED, QUEUE, SETUP, WALK, WORK
from opsim.subjects.people.worker import set_free, stop
from opsim.subjects.routes.routing import cancel, take_claim
from opsim.subjects.sequencing.setups import take_up
from opsim.subjects.stations.station import call_off, go_on, next_in_line, next_task, perform, quiet, seat, stand_still


@step
def stop_station(floor: Floor, station: Station) -> None:
    """The station stands still for one reason more: work is broken off, nobody is called, nothing begins.

    The station needs ``has_seated``: a block that stops stations says so when it is installed.
    """
    shut_station(floor, station)
    for job in station.seated:
        if job.kind == WORK or job.kind == SETUP:
            interrupt(floor, job, station.stands_for)
            station.standing.append(job)


@step
def shut_station(floor: Floor, station: Station) -> None:
    """One reason more to stand still, once what is under way is done: nobody is called, nothing begins."""
    station.down += 1
    floor.n_down += 1
    for claim in station.calling:
        stand_still(floor, station, claim.job)
    while station.calling:
        take_claim(floor, station.calling, len(station.calling) - 1)
    quiet(floor, station)


@step
def start_station(floor: Floor, station: Station) -> None:
    """One reason less to stand still; where it was the last one, jobs on servers go on."""
    station.down -= 1
    floor.n_down -= 1
    if station.down:
        return
    n = len(station.standing)
    while n:  # those that stand again meanwhile are behind the n
        at = 0
        for i in range(1, n):
            if station.standing[i].number < station.standing[at].number:
                at = i
        job = station.standing[at]
        del station.standing[at]
        n -= 1
        go_on(floor, job)
    if station.serve:
        station.serve.line(floor, station)


@step
def interrupt(floor: Floor, job: Job, cause: int) -> None:
    """The performance under way is broken off: the piece that was done is written, its workers are free, and the job is
    held. ``job.rest_s`` and ``job.progress_from`` say what is left: the same worker goes on with it, another one takes
    his own next time for the same share.
    """
    left_s = job.since_s + job.duration_s - floor.now
    done = progress(job, floor.now)
    job_now(floor, job, HELD, cause)
    job.rest_s, job.progress_from = left_s, done
    station = job.station
    if station.meter:
        station.meter.end_line(floor, station.meter)
    if job.over:
        cancel(job.over)
        job.over = NOTHING
    if job.worker >= 0:
        worker = floor.workers[job.worker]
        stop(floor, worker)
        set_free(floor, worker)
    release_team(floor, job)
    tell_broken_off(floor, job)


@step
def tell_broken_off(floor: Floor, job: Job) -> None:
    """Whoever has to know that a job's performance is broken off."""
    for hook in floor.broken_off:
        hook.line(floor, hook.subject, job)


@step
def take_over(floor: Floor, job: Job, worker: Worker) -> None:
    """A worker who stands at the job goes on with it, and with its tools; who did it until now is free.

    Where the station has closed since it was begun, he does it to its end.
    """
    station = job.station
    down = station.down
    if job.kind == WORK or job.kind == SETUP:
        floor.handed_over = job
        interrupt(floor, job, NO_WORKER)
        floor.handed_over = NOTHING
        station.down = 0  # work is under way, so it is closed at most, and that does not concern what was begun
    else:
        call_off(floor, station, job)
    worker.job, worker.station = job, station
    if job.setup_task < 0:
        next_task(floor, job, worker)
    else:
        perform(floor, job, worker)
    station.down = down


@step
def forget_progress(floor: Floor, job: Job) -> None:
    """What was done of a broken-off performance is lost: it is done again from its beginning."""
    job.rest_s = 0.0
    job.progress_from = 0.0


@step
def release_team(floor: Floor, job: Job) -> None:
    """Workers who stand by a job, work on it together, or wait for others, are free."""
    job.has_team = 0
    while job.team:
        worker = job.team.pop(0)
        if worker.stint:
            log_worker(floor, worker)
            worker.stint = NOTHING
        stop(floor, worker)
        set_free(floor, worker)


@struct
class Preempting:
    """restart : whether what was done of a performance is lost."""

    station: Station
    restart: int


RESTART = "restart"
_may_preempt, _victim_key = inlined(rules.may_preempt), inlined(rules.victim_key)
_as_job = cast(Job)


@step
def preempt(floor: Floor, what: Preempting) -> bool:
    """True where servers changed hands."""
    changed, station = False, what.station
    while len(station.queue) > 0 and not station.down:
        job = _victim(floor, station)
        if not job:
            break
        _give_up_server(floor, station, job, what.restart)
        changed = True
    return changed


@step
def _victim(floor: Floor, station: Station) -> Job:
    """Who loses the server to the first of the queue; nothing: nobody is of lower priority and can be broken off."""
    highest = station.queue[0].priority
    for i in range(1, len(station.queue)):
        highest = max(highest, station.queue[i].priority)
    found: Job = _as_job(0)
    for job in station.seated:
        if _may_preempt(highest, job.priority) and _can_stop(job) and (not found or _gives_way_before(job, found)):
            found = job
    return found


@inlined
def _gives_way_before(one: Job, other: Job) -> bool:
    key = _victim_key(one.priority, one.since_s, one.number)
    return key < _victim_key(other.priority, other.since_s, other.number)


@inlined
def _can_stop(job: Job) -> bool:
    """In work, or waiting for a worker: who waits for a place, parts or a tool, or is set up for, keeps the server."""
    return job.kind == WORK or (job.kind == HELD and (job.cause == NO_WORKER or job.cause == AWAY))


@step
def _give_up_server(floor: Floor, station: Station, job: Job, restart: int) -> None:
    if job.kind == WORK:
        interrupt(floor, job, PREEMPTED)
    else:
        _call_off(floor, station, job)
    if station.setups:
        take_up(floor, job)
    if restart:
        forget_progress(floor, job)
    if job.ahead and not job.ahead.own:  # else who took the server might wait for it
        give_up_place(floor, job, job.ahead)
    for told in floor.lost_server:
        told.line(floor, told.subject, job, station)
    job_now(floor, job, QUEUE, PREEMPTED)
    job.stage = GOES_ON
    be_unseated(floor, station, job)
    station.free_servers += 1
    station.queue.append(job)
    seat(floor, station, next_in_line(floor, station))


@step
def _call_off(floor: Floor, station: Station, job: Job) -> None:
    """The job calls for nobody any more; who is on his way to it comes all the same, and is free there."""
    call_off(floor, station, job)
    if job.setup_task >= 0:
        forget_progress(floor, job)  # of the set-up: its server is another's now
        job.setup_task = -1
    for rank in range(floor.n_workers):
        worker = floor.workers[rank]
        if worker.kind == WALK and worker.job is job:
            worker.job = NOTHING


def install_preemption(build: Any) -> None:
    """Stations where what was begun may be broken off for something more important."""
    for queue in build.plan.queues:
        if queue.preempt:
            what = build.arena.new("Preempting")
            what.station, what.restart = build.stations[queue.station], queue.preempt == RESTART
            build.seat(what.station)
            build.hang(build.floor.dispatchers, preempt, what)
