"""Performances that are broken off, and stations that stand still: for breakdowns, maintenance, pre-emption."""

from opsim.engine.simpy_engine.floor import Floor, cancel, progress
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.station import call_off, go_on, next_task, perform, quiet, stand_still
from opsim.engine.simpy_engine.worker import log_worker, set_free, stop
from opsim.log import HELD, NO_WORKER, SETUP, WORK


def stop_station(floor: Floor, station: Station) -> None:
    """The station stands still for one reason more: work is broken off, nobody is called, nothing begins.

    The station needs ``seated``: a block that stops stations gives them an empty list when it is installed.
    """
    shut_station(floor, station)
    for job in station.seated or ():
        if job.kind == WORK or job.kind == SETUP:
            interrupt(floor, job, station.stands_for)
            station.standing.append(job)


def shut_station(floor: Floor, station: Station) -> None:
    """One reason more to stand still, once what is under way is done: nobody is called, nothing begins."""
    station.down += 1
    for _, _, _, job in station.calling:
        stand_still(floor, station, job)
    station.calling.clear()
    quiet(floor, station)


def start_station(floor: Floor, station: Station) -> None:
    """One reason less to stand still; where it was the last one, jobs on servers go on."""
    station.down -= 1
    if station.down:
        return
    standing, station.standing = station.standing, []
    for job in sorted(standing, key=lambda job: job.number):
        go_on(floor, job)
    if station.serve is not None:
        station.serve(floor, station)


def interrupt(floor: Floor, job: Job, cause: int) -> None:
    """The performance under way is broken off: the piece that was done is written, its workers are free, and the job is
    held. ``job.rest_s`` and ``job.progress_from`` say what is left: the same worker goes on with it, another one takes
    his own next time for the same share.
    """
    rest_s = job.since_s + job.duration_s - floor.now
    done = progress(job, floor.now)
    floor.job_now(job, HELD, cause)
    job.rest_s, job.progress_from = rest_s, done
    station = job.station
    if station.meter is not None:
        station.meter.end(floor)
    if job.over is not None:
        cancel(job.over)
        job.over = None
    if job.worker >= 0:
        worker = floor.workers[job.worker]
        stop(floor, worker)
        set_free(floor, worker)
    release_team(floor, job)
    for told in floor.broken_off:
        told(floor, job)


def leave(floor: Floor, job: Job, cause: int) -> None:
    """Who works on the job leaves it on its server; it waits there for a cause, and calls for nobody."""
    interrupt(floor, job, cause)


def call_again(floor: Floor, job: Job) -> None:
    """A job that was left calls for anybody, as it did before its task began."""
    go_on(floor, job)


def take_over(floor: Floor, job: Job, worker: Worker) -> None:
    """A worker who stands at the job goes on with it, and with its tools; who did it until now is free.

    Where the station has closed since it was begun, he does it to its end.
    """
    station = job.station
    down = station.down
    if job.kind == WORK or job.kind == SETUP:
        floor.handed_over = job
        interrupt(floor, job, NO_WORKER)
        floor.handed_over = None
        station.down = 0  # NOTE: work is under way, so it is closed at most, and that does not concern what was begun
    else:
        call_off(floor, station, job)
    worker.job, worker.station = job, station
    _begin_again(floor, job, worker)
    station.down = down


def _begin_again(floor: Floor, job: Job, worker: Worker) -> None:
    if job.setup_task < 0:
        next_task(floor, job, worker)
    else:
        perform(floor, job, worker)


def forget_progress(job: Job) -> None:
    """What was done of a broken-off performance is lost: it is done again from its beginning."""
    job.rest_s = job.progress_from = 0.0


def release_team(floor: Floor, job: Job) -> None:
    """Workers who stand by a job, work on it together, or wait for others, are free."""
    team, job.team = job.team, None
    for worker in team or ():
        if worker.stint is not None:
            log_worker(floor, worker)
            worker.stint = None
        stop(floor, worker)
        set_free(floor, worker)
