"""Places downstream and behind: blocking before service, and buffers for finished jobs."""

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import leave_server, next_step, want_place
from opsim.engine.simpy_engine.state import Ahead, Job, Station
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import AFTER, BLOCKED, HELD, NO_PLACE, PICKUP, QUEUE

PLACE_COMES = 10
"""The place of this among the preparations of a job."""


def install(floor: Floor) -> None:
    """Stations that ask for a place downstream first, and those with a buffer behind."""
    for station in floor.stations:
        if station.plan.place_first:
            station.add_stage(PLACE_COMES, _has_place)
        if station.plan.buffer_after:
            station.seated = [] if station.seated is None else station.seated
            station.clear, station.vacate = _put_away, _vacate


def _has_place(floor: Floor, job: Job) -> bool:
    """Claim a place at the next operation; True where it is kept, or none is needed."""
    ahead = job.ahead
    if ahead is not None and (ahead.step < 0 or ahead.station is not None):
        return True
    step = next_step(floor, job) if ahead is None else ahead.step  # who lost his server may have lost his place too
    gate = job.gate if step < 0 else floor.steps[job.product][step][2]
    stays = step >= 0 and job.station in gate.stations and job.keeps_place and gate.allows is None and gate.pick is None
    if step < 0 or stays:
        job.ahead = Ahead(step, gate, job.station if stays else None, stays)
        return True
    floor.job_now(job, HELD, NO_PLACE)
    want_place(floor, job, step)
    return False


def _put_away(floor: Floor, station: Station, job: Job) -> None:
    """A finished job that has to go on clears its server, where there is room behind."""
    if len(station.put_away) < station.plan.buffer_after and not _stays(job):
        _clear_server(floor, station, job)


def _stays(job: Job) -> bool:
    """Whether the job's next operation is at the station where it is, and its place there the one it has."""
    return job.ahead is not None and job.ahead.own


def _clear_server(floor: Floor, station: Station, job: Job) -> None:
    """The job leaves its server for the buffer behind: its place at the station does not count any more."""
    floor.job_now(job, QUEUE, PICKUP if job.cause == PICKUP else AFTER)
    station.put_away.append(job)
    station.capacity += 1
    if job.held_by is not None and not job.plan.carried:
        worker, job.held_by = job.held_by, None
        set_free(floor, worker)
    leave_server(floor, station, job)
    floor.stir(station)


def _vacate(floor: Floor, station: Station, job: Job) -> None:
    """A job goes on: from its server, or from the buffer behind, where the oldest that is done follows."""
    if job not in station.put_away:
        leave_server(floor, station, job)
        return
    station.put_away.remove(job)
    station.capacity -= 1
    done = [one for one in station.seated or () if _is_done(one) and not _stays(one)]
    if done:
        _clear_server(floor, station, min(done, key=lambda one: (one.since_s, one.number)))


def _is_done(job: Job) -> bool:
    """Whether a job on a server waits for room downstream, or for a vehicle."""
    return job.kind == BLOCKED or (job.kind == HELD and job.cause == PICKUP)
