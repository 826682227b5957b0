"""Accumulating conveyors: each job rides on until it stands behind another one."""

from opsim.engine.rules import COMPLETION
from opsim.engine.simpy_engine import boarding, rigid_conveyors
from opsim.engine.simpy_engine.belts import Belt, RigidBelt
from opsim.engine.simpy_engine.boarding import hang, rank_of
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import operation_done
from opsim.engine.simpy_engine.state import Job
from opsim.log import QUEUE, TRANSPORT

RIDDEN, CLOSED_UP = "job has ridden", "job has closed up"


def install(floor: Floor) -> None:
    """Jobs that come to a conveyor get on, and who leaves it gets off."""
    rigid = []
    for plan in floor.plan.conveyors:
        station = floor.stations[plan.station]
        if plan.accumulating:
            hang(Belt(plan, station), _get_on, _get_off)
        else:
            rigid.append(RigidBelt(plan, station))
    if rigid:
        rigid_conveyors.install(floor, rigid)


def _get_on(floor: Floor, belt: Belt, job: Job) -> None:
    belt.jobs.append(job)
    belt.last_on_s = floor.now
    floor.job_now(job, TRANSPORT)
    _later(floor, belt, job, belt.plan.travel_s, RIDDEN)


def _get_off(floor: Floor, belt: Belt, job: Job) -> None:
    """The first job is gone: the next one comes to the end a pitch later, if it is not on its way there still."""
    belt.jobs.remove(job)
    belt.last_off_s = floor.now
    if belt.jobs and belt.jobs[0].kind == QUEUE:
        _later(floor, belt, belt.jobs[0], belt.plan.headway_s, CLOSED_UP)


def _ridden(floor: Floor, subject: tuple[Belt, Job]) -> None:
    """As much time is over as the ride takes: the job is at the end, or stands behind others."""
    belt, job = subject
    behind_s = belt.last_off_s + belt.plan.headway_s - floor.now
    if belt.jobs[0] is not job:
        floor.job_now(job, QUEUE)
    elif behind_s > 0:
        floor.job_now(job, QUEUE)
        _later(floor, belt, job, behind_s, CLOSED_UP)
    else:
        operation_done(floor, job)


def _closed_up(floor: Floor, subject: tuple[Belt, Job]) -> None:
    operation_done(floor, subject[1])


def _later(floor: Floor, belt: Belt, job: Job, delay_s: float, what: str) -> None:
    floor.alarm(delay_s, COMPLETION, rank_of(floor, belt), job.number, what, (belt, job))


HANDLERS: dict[str, Handler] = {
    RIDDEN: _ridden,
    CLOSED_UP: _closed_up,
    **boarding.HANDLERS,
    **rigid_conveyors.HANDLERS,
}
