"""Places downstream and behind: blocking before service, and buffers for finished jobs."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import NOTHING, drop, fresh, inlined, step
from opsim.engine.floor.material import leave_server, want_place
from opsim.engine.floor.parts.events import stir
from opsim.engine.floor.parts.gates import keeps_place, leads_to
from opsim.engine.floor.parts.records import Ahead
from opsim.engine.floor.parts.rows import job_now
from opsim.engine.floor.parts.state import Floor, Gate, Job, Station
from opsim.engine.floor.parts.ways import step_after
from opsim.engine.floor.worker import set_free
from opsim.log import AFTER, BLOCKED, HELD, NO_PLACE, PICKUP, QUEUE

PLACE_COMES = 10
"""The place of this among the preparations of a job."""
_new_ahead = fresh(Ahead)


def install(build: Any) -> None:
    """Stations that ask for a place downstream first, and those with a buffer behind."""
    for station, plan in zip(build.stations, build.plan.stations):
        if plan.place_first:
            build.hang(station.stages, has_place, None, PLACE_COMES)
        if plan.buffer_after:
            build.seat(station)
            station.clear, station.vacate = build.hook(put_away), build.hook(vacate)


@step
def has_place(floor: Floor, subject: Any, job: Job) -> bool:
    """Claim a place at the next operation; True where it is kept, or none is needed."""
    ahead = job.ahead
    if ahead and (ahead.step < 0 or ahead.station):
        return True
    step = ahead.step if ahead else step_after(floor, job)  # who lost his server may have lost his place too
    gate = job.plan.steps[step].gate if step >= 0 else job.gate
    stays = step >= 0 and _may_stay(gate, job)
    if step < 0 or stays:
        _need_none(floor, job, step, gate, stays)
        return True
    job_now(floor, job, HELD, NO_PLACE)
    want_place(floor, job, step)
    return False


@inlined
def _may_stay(gate: Gate, job: Job) -> bool:
    """Whether its place here is one of those that it wants, and nothing else is asked for them."""
    return leads_to(gate, job) and keeps_place(job) and len(gate.allows) == 0 and not gate.pick


@inlined
def _need_none(floor: Floor, job: Job, step: int, gate: Gate, stays: bool) -> None:
    """The job needs no other place than it has."""
    ahead: Ahead = _new_ahead(floor)
    ahead.step, ahead.gate = step, gate
    if stays:
        ahead.station, ahead.own = job.station, 1
    job.ahead = ahead


@step
def put_away(floor: Floor, station: Station, job: Job) -> None:
    """A finished job that has to go on clears its server, where there is room behind."""
    if len(station.put_away) < station.buffer_after and not _stays(job):
        clear_server(floor, station, job)


@inlined
def _stays(job: Job) -> bool:
    """Whether the job's next operation is at the station where it is, and its place there the one it has."""
    if job.ahead:
        return job.ahead.own == 1
    return False


@step
def clear_server(floor: Floor, station: Station, job: Job) -> None:
    """The job leaves its server for the buffer behind: its place at the station does not count any more."""
    job_now(floor, job, QUEUE, PICKUP if job.cause == PICKUP else AFTER)
    station.put_away.append(job)
    station.capacity += 1
    if job.held_by and not job.plan.carried:
        worker = job.held_by
        job.held_by = NOTHING
        set_free(floor, worker)
    leave_server(floor, station, job)
    stir(floor, station)


@step
def vacate(floor: Floor, station: Station, job: Job) -> None:
    """A job goes on: from its server, or from the buffer behind, where the oldest that is done follows."""
    if job not in station.put_away:
        leave_server(floor, station, job)
        return
    drop(station.put_away, job)
    station.capacity -= 1
    oldest: Job = floor.handed_over
    found = False
    for one in station.seated:
        if _is_done(one) and not _stays(one) and (not found or _is_older(one, oldest)):
            oldest, found = one, True
    if found:
        clear_server(floor, station, oldest)


@inlined
def _is_done(job: Job) -> bool:
    """Whether a job on a server waits for room downstream, or for a vehicle."""
    return job.kind == BLOCKED or (job.kind == HELD and job.cause == PICKUP)


@inlined
def _is_older(one: Job, other: Job) -> bool:
    if one.since_s != other.since_s:
        return one.since_s < other.since_s
    return one.number < other.number
