"""Set-ups: each server remembers what it did last, and is set up for a job of another class."""

from typing import NamedTuple

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Job, Seat, Station
from opsim.engine.simpy_engine.station import begin_setup
from opsim.plan.setup import NO_SETUP, SetupPlan

SETTING_UP_COMES = 40
"""The place of set-ups among the preparations of a job."""


class Stopped(NamedTuple):
    """The work a job was in: whose and which, and what is left of it, as the job says it."""

    worker: int
    k: int
    performance_id: int
    pace_shift: float
    asked: tuple[float, float] | None
    rest_s: float
    progress_from: float


class Servers(list[Job]):
    """The jobs on a station's servers, and what each server was last set up for.

    free : of the servers without a job; of : of the others, by job, or by the seat that jobs share
    left : set-ups still to do for a job, and 0 where it has them; stopped : the work it was in when it lost its server
    """

    def __init__(self, plan: SetupPlan, n_servers: int):
        super().__init__()
        self.plan = plan
        self.free = [plan.first] * n_servers
        self.of: dict[Job | Seat, int] = {}
        self.left: dict[Job, int] = {}
        self.stopped: dict[Job, Stopped] = {}

    def append(self, job: Job) -> None:
        """The job takes the free server with the shortest set-up."""
        super().append(job)
        if _key(job) not in self.of:
            free = self.free
            last = free[0]
            if len(free) > 1:
                last = min(free, key=lambda last: (self.plan.needed(last, job.product)[1], last))
            free.remove(last)
            self.of[_key(job)] = last

    def remove(self, job: Job) -> None:
        """The job leaves its server, which others may share."""
        super().remove(job)
        self.left.pop(job, None)
        if job.seat is None or job.seat.n_jobs == 1:
            self.free.append(self.of.pop(_key(job)))

    def next_s(self, product: int) -> float:
        """Mean time of the shortest set-up for a product, of the free servers, or of all where none is free."""
        return min(self.plan.needed(last, product)[1] for last in self.free or self.of.values())


def _key(job: Job) -> Job | Seat:
    return job if job.seat is None else job.seat


def install(floor: Floor) -> None:
    """Stations with set-ups."""
    for plan in floor.plan.setups:
        station = floor.stations[plan.station]
        station.seated = station.setups = Servers(plan, station.plan.servers)
        station.setup_attended = plan.attended
        station.add_stage(SETTING_UP_COMES, _set_up)


def setup_s(station: Station, job: Job) -> float:
    """Mean time of the set-up that a job would need at a station now."""
    return 0.0 if station.setups is None else station.setups.next_s(job.product)


def _set_up(floor: Floor, job: Job) -> bool:
    """Set the job's server up, as often as the task is repeated; True where the server is as the job needs it."""
    servers: Servers = job.station.setups  # type: ignore[assignment]
    task, _ = servers.plan.needed(servers.of[_key(job)], job.product)
    left = servers.left.get(job)
    if left is None:
        left = 0 if task == NO_SETUP else floor.plan.tasks[task].repeat
        if left and job.rest_s:
            servers.stopped[job] = Stopped(*(getattr(job, name) for name in Stopped._fields))
            job.rest_s = job.progress_from = 0.0
    if left:
        servers.left[job] = left - 1
        begin_setup(floor, job, task)
        return False
    servers.of[_key(job)] = servers.plan.class_of[job.product]
    take_up(floor, job)
    return True


def take_up(floor: Floor, job: Job) -> None:
    """The job has before it what was left of its work when it lost its server."""
    stopped = job.station.setups.stopped.pop(job, None)  # type: ignore[union-attr]
    if stopped is not None:
        floor.log_job(job)  # the set-up, while it is known who did it
        job.since_s = floor.now
        for name, value in zip(Stopped._fields, stopped):
            setattr(job, name, value)
