"""Performances that are broken off, and stations that stand still: for breakdowns, maintenance, pre-emption."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, step
from opsim.engine.floor.parts.claims import take_claim
from opsim.engine.floor.parts.effects import stop
from opsim.engine.floor.parts.events import cancel
from opsim.engine.floor.parts.rows import job_now, log_worker, progress
from opsim.engine.floor.parts.state import Floor, Job, Station, Worker
from opsim.engine.floor.station import call_off, go_on, next_task, perform, quiet, stand_still
from opsim.engine.floor.worker import set_free
from opsim.log import HELD, NO_WORKER, SETUP, WORK


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
