"""Tools: of a station for as long as a job is there, of a task for as long as somebody is at it."""

from functools import partial

from opsim.engine.simpy_engine.crib import AT_STATION, Crib
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.grips import Want
from opsim.engine.simpy_engine.state import Job, Station
from opsim.engine.simpy_engine.station import next_task, proceed

STAGE = 30
"""Among the preparations of a seated job."""


def install(floor: Floor) -> Crib | None:
    """The crib where there are tools, asked wherever a station needs some; None where there are none."""
    if not floor.plan.tools:
        return None
    crib = Crib(floor)
    floor.dispatchers.append(crib.give_out)
    floor.left_station.append(partial(_left_station, crib))
    floor.lost_server.append(crib.leave)
    floor.broken_off.append(crib.break_off)
    floor.call_off.append(crib.call_off)
    floor.closing.append(crib.close)
    for station in floor.stations:
        if station.plan.needs:
            station.add_stage(STAGE, partial(_for_station, crib))
            station.seated = [] if station.seated is None else station.seated
    return crib


def _for_station(crib: Crib, floor: Floor, job: Job) -> bool:
    """The tools that stay with the job until it leaves its station; with a batch, until the last of it does."""
    needs = job.station.plan.needs
    return crib.take(job, Want(AT_STATION, needs, -1, lambda: proceed(floor, job)))


def _left_station(crib: Crib, floor: Floor, job: Job, station: Station) -> None:
    """What the station needs goes on to another one of the job's batch that is there yet; the rest is given back."""
    if job.number not in crib.known:
        return
    if job.seat is not None and crib.has(job, AT_STATION):
        other = next((one for one in station.seated or () if one is not job and one.seat is job.seat), None)
        if other is not None:
            crib.pass_on(floor, job, other)
    crib.leave(floor, job, station)


def for_task(crib: Crib, floor: Floor, job: Job) -> bool:
    """Whether the tools of the task a job has come to are there; those of the one it is done with are given back.

    An automatic run takes them at once, a worker when he sets out, a team when all of it does.
    """
    station = job.station
    position = job.task_position
    crib.put_back_tasks(job, keep=position)
    task = station.tasks[position]
    plan = floor.plan.tasks[task]
    if not plan.needs or crib.has(job, position):
        return True
    want = Want(position, plan.needs, task, lambda: next_task(floor, job, None), at_once=plan.automatic)
    if not crib.take(job, want):
        return False
    if not plan.automatic and plan.team == 1:
        crib.call(job, want)
    return True


def at_hand(crib: Crib, _floor: Floor, job: Job) -> None:
    """A worker is there: the tools he did not bring, since he was at hand, he takes now."""
    if job.with_tools:
        crib.sent(_floor, job)


def tasks_done(crib: Crib, _floor: Floor, job: Job) -> bool:
    """All tasks are done: their tools are given back before anything becomes of the job."""
    crib.put_back_tasks(job)
    return True
