"""Conveyors that do not accumulate: while the job at the end cannot get off, all of them stand still."""

from opsim.engine.rules import COMPLETION
from opsim.engine.simpy_engine.belts import RigidBelt
from opsim.engine.simpy_engine.boarding import forget_opening, hang, rank_of
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import operation_done
from opsim.engine.simpy_engine.state import Job
from opsim.log import QUEUE, TRANSPORT

AT_END = "job is at the end of the belt"


def install(floor: Floor, belts: list[RigidBelt]) -> None:
    """Jobs that come to such a conveyor get on, and who leaves it gets off."""
    for belt in belts:
        hang(belt, _get_on, _get_off)
    floor.dispatchers.append(lambda floor: _halt(floor, belts))


def _get_on(floor: Floor, belt: RigidBelt, job: Job) -> None:
    belt.on_at_s[job.number] = belt.moved_at_s(floor.now)
    belt.jobs.append(job)
    floor.job_now(job, QUEUE if belt.halted else TRANSPORT)
    if len(belt.jobs) == 1:
        _first_rides(floor, belt)


def _get_off(floor: Floor, belt: RigidBelt, job: Job) -> None:
    """The first job is gone, and the belt moves on."""
    belt.jobs.remove(job)
    del belt.on_at_s[job.number]
    belt.stands, belt.since_s = False, floor.now
    if belt.halted:
        belt.halted = False
        for other in belt.jobs:
            floor.job_now(other, TRANSPORT)
    if belt.jobs:
        _first_rides(floor, belt)


def _first_rides(floor: Floor, belt: RigidBelt) -> None:
    job = belt.jobs[0]
    rest_s = belt.rest_s(job, belt.plan.travel_s, floor.now)
    floor.alarm(rest_s, COMPLETION, rank_of(floor, belt), job.number, AT_END, belt)


def _at_end(floor: Floor, belt: RigidBelt) -> None:
    """The belt stands from now on, unless the first job gets off at once."""
    belt.moved_s, belt.stands = belt.moved_at_s(floor.now), True
    forget_opening(belt)
    operation_done(floor, belt.jobs[0])


def _halt(floor: Floor, belts: list[RigidBelt]) -> bool:
    """The rows of jobs on belts that came to stand say so."""
    for belt in belts:
        if belt.stands and not belt.halted:
            belt.halted = True
            for other in list(belt.jobs)[1:]:
                floor.job_now(other, QUEUE)
    return False


HANDLERS: dict[str, Handler] = {AT_END: _at_end}
