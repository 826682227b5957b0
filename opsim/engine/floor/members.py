"""Who belongs to a team, until when."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, List, drop, inlined, step
from opsim.engine.floor.parts.bits import may_serve
from opsim.engine.floor.parts.keys import is_better, keep_best, pair_key
from opsim.engine.floor.parts.performing import units
from opsim.engine.floor.parts.state import Floor, Job, Station, Worker
from opsim.engine.floor.worker import set_free
from opsim.log import WALK


@step
def choose(floor: Floor, job: Job, station: Station) -> bool:
    """The free workers who go, by the rule of allocation, in natural order: ``teams.team``. False: they are too few.

    Who stays until the job's tasks here are done comes first.
    """
    able, team = floor.teams.able, floor.teams.team
    able.clear()
    team.clear()
    for worker in floor.free:
        if _may_work(worker, job, station):
            able.append(worker)
    n = floor.tasks[station.tasks[job.task_position]].team
    if len(able) < n:
        return False
    while len(team) < n:
        best = _best_of(floor, job, station)
        drop(able, best)
        _insort(floor, team, best)
    return True


@step
def _best_of(floor: Floor, job: Job, station: Station) -> Worker:
    """Of those who can go, who comes first."""
    able, best = floor.teams.able, floor.no_worker
    for worker in able:
        stays = worker.staying is job
        if best and stays != (best.staying is job) and not stays:
            continue
        pair_key(floor, worker, station, job, 1 + len(station.queue), job.since_s)
        better = True
        if best:
            better = stays != (best.staying is job) or is_better(floor)
        if better:
            best = worker
            keep_best(floor)
    return best


@inlined
def _insort(floor: Floor, team: List[Worker], worker: Worker) -> None:
    """Put somebody into a team at his place in natural order."""
    at = len(team)
    while at > 0 and worker.rank < team[at - 1].rank:
        at -= 1
    team.insert(at, worker)


@step
def disband(floor: Floor, job: Job) -> None:
    """Who has come is free; who is on his way comes, and is free there."""
    if not job.has_team:
        return
    job.has_team = 0
    for worker in job.team:
        if worker.kind == WALK:
            worker.job = NOTHING
            worker.station = NOTHING
        else:
            set_free(floor, worker)
    job.team.clear()


@step
def comes_again(floor: Floor, job: Job) -> bool:
    """Whether the performance that ends now is followed by another one of the same task."""
    return job.repeats_done + 1 < job.station.repeats[job.task_position] * units(job)


@step
def all_may_stay(floor: Floor, job: Job) -> bool:
    """Whether the whole team is there, and each of them may still be sent to where it works, or stays for the job."""
    if len(job.team) != floor.tasks[job.station.tasks[job.task_position]].team:
        return False
    for worker in job.team:
        if not _may_work(worker, job, job.station):
            return False
    return True


@inlined
def _may_work(worker: Worker, job: Job, station: Station) -> bool:
    """Whether somebody may be sent to a station, or is about to go and does the job's tasks there first."""
    return may_serve(worker, station) or worker.staying is job
