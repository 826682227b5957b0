"""Who belongs to a team, until when."""

from opsim.engine.simpy_engine.floor import Floor, pair_key
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.station import units
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import WALK


def chosen(floor: Floor, job: Job, station: Station) -> list[Worker]:
    """The free workers who go, by the rule of allocation, in natural order; none where they are too few.

    Who stays until the job's tasks here are done comes first.
    """
    n = floor.plan.tasks[station.tasks[job.task_position]].team
    able = [worker for worker in floor.free.values() if _may_work(worker, job, station)]
    if len(able) < n:
        return []
    n_waiting = 1 + len(station.queue)

    def key(worker: Worker) -> tuple[float, ...]:
        return worker.staying is not job, *pair_key(floor, worker, station, job, n_waiting, job.since_s)

    return sorted(sorted(able, key=key)[:n], key=lambda worker: worker.rank)


def disband(floor: Floor, job: Job) -> None:
    """Who has come is free; who is on his way comes, and is free there."""
    team, job.team = job.team, None
    for worker in team or ():
        if worker.kind == WALK:
            worker.job = worker.station = None
        else:
            set_free(floor, worker)


def comes_again(job: Job) -> bool:
    """Whether the performance that ends now is followed by another one of the same task."""
    station = job.station
    times = station.repeats[job.task_position] * (1 if job.lot == 1 else units(job))
    return job.repeats_done + 1 < times


def all_may_stay(floor: Floor, job: Job) -> bool:
    """Whether the whole team is there, and each of them may still be sent to where it works, or stays for the job."""
    team: list[Worker] = job.team  # type: ignore[assignment]
    n = floor.plan.tasks[job.station.tasks[job.task_position]].team
    return len(team) == n and all(_may_work(worker, job, job.station) for worker in team)


def _may_work(worker: Worker, job: Job, station: Station) -> bool:
    """Whether somebody may be sent to a station, or is about to go and does the job's tasks there first."""
    return worker.may_serve(station) or worker.staying is job
