"""Pre-emption: a job of higher priority takes the server of a lower one."""

from collections.abc import Callable

from opsim.engine.rules.sequencing import may_preempt, victim_key
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.interruption import forget_progress, interrupt
from opsim.engine.simpy_engine.material import give_up_place
from opsim.engine.simpy_engine.setup import take_up
from opsim.engine.simpy_engine.state import GOES_ON, Job, Station
from opsim.engine.simpy_engine.station import call_off, next_in_line, seat
from opsim.log import AWAY, HELD, NO_WORKER, PREEMPTED, QUEUE, WALK, WORK

RESTART = "restart"


def install(floor: Floor) -> None:
    """Stations where what was begun may be broken off for something more important."""
    for queue in floor.plan.queues:
        if queue.preempt:
            station = floor.stations[queue.station]
            station.seated = [] if station.seated is None else station.seated
            floor.dispatchers.append(_preempting(station, queue.preempt == RESTART))


def _preempting(station: Station, restart: bool) -> Callable[[Floor], bool]:
    def preempt(floor: Floor) -> bool:
        """True where servers changed hands."""
        changed = False
        while station.queue and not station.down and (job := _victim(station)) is not None:
            _give_up_server(floor, station, job, restart)
            changed = True
        return changed

    return preempt


def _victim(station: Station) -> Job | None:
    """Who loses the server to the first of the queue; None where nobody is of lower priority and can be broken off."""
    highest = max(job.priority for job in station.queue)
    losing = [job for job in station.seated or () if may_preempt(highest, job.priority) and _can_stop(job)]
    return min(losing, key=lambda job: victim_key(job.priority, job.since_s, job.number)) if losing else None


def _can_stop(job: Job) -> bool:
    """In work, or waiting for a worker: who waits for a place, parts or a tool, or is set up for, keeps the server."""
    return job.kind == WORK or (job.kind == HELD and job.cause in (NO_WORKER, AWAY))


def _give_up_server(floor: Floor, station: Station, job: Job, restart: bool) -> None:
    if job.kind == WORK:
        interrupt(floor, job, PREEMPTED)
    else:
        _call_off(floor, station, job)
    if station.setups is not None:
        take_up(floor, job)
    if restart:
        forget_progress(job)
    if job.ahead is not None and not job.ahead.own:  # else who took the server might wait for it
        give_up_place(floor, job, job.ahead)
    for told in floor.lost_server:
        told(floor, job, station)
    floor.job_now(job, QUEUE, PREEMPTED)
    job.stage = GOES_ON
    station.seated.remove(job)  # type: ignore[union-attr]
    station.free_servers += 1
    station.queue.append(job)
    seat(floor, station, next_in_line(station))


def _call_off(floor: Floor, station: Station, job: Job) -> None:
    """The job calls for nobody any more; who is on his way to it comes all the same, and is free there."""
    call_off(floor, station, job)
    if job.setup_task >= 0:
        forget_progress(job)  # of the set-up: its server is another's now
        job.setup_task = -1
    for worker in floor.workers:
        if worker.job is job and worker.kind == WALK:
            worker.job = None
