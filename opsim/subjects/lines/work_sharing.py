"""Work that two stations share.

Work sharing: the last tasks of a station are done there, or first at the next one, as the job comes to them.
"""

from __future__ import annotations

from typing import Any

from opsim.engine import rules
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.flow import operation_done
from opsim.engine.floor.machine import inlined, new_ints, step, struct
from opsim.engine.floor.settle import operation_over
from opsim.engine.floor.state import Job, Station, Worker
from opsim.log import WALK


@struct
class Shared:
    """number : among all of them; n_shares : how many these are; n : tasks that are shared

    filled : the share of the partner's buffer from which on the station does them itself
    """

    number: int
    n_shares: int
    station: Station
    partner: Station
    n: int
    filled: float


FIRST = 0
"""Among what is asked before each task, and when an operation is done: a task is looked at when it is to be done."""
_keeps_shared = inlined(rules.keeps_shared)


@inlined
def _position(shared: Shared, job: Job) -> int:
    """Which of the shared tasks the job has come to; below 0: none of them yet."""
    return job.task_position - (shared.station.n_tasks - shared.n)


@inlined
def _keeps(shared: Shared) -> bool:
    partner = shared.partner
    n_inside = partner.n_inside - len(partner.put_away)
    return _keeps_shared(n_inside, partner.servers, partner.buffer, shared.filled)


@inlined
def _note(floor: Floor, shared: Shared, job: Job, done: int) -> None:
    """So much of the shared work is done."""
    if not job.block.shared:
        job.block.shared = new_ints(floor, shared.n_shares)
    job.block.shared[shared.number] = 1 + done


@step
def _who_is_at(floor: Floor, job: Job) -> Worker:
    """Who is with the job; nobody: who is on his way there, or free, is not."""
    for rank in range(floor.n_workers):
        worker = floor.workers[rank]
        if worker.job is job and worker.kind != WALK and not worker.in_free:
            return worker
    return floor.no_worker


@step
def before_task(floor: Floor, shared: Shared, job: Job) -> bool:
    """Whether the job stays for its next task; where it is left to the partner, it is done here, and goes on."""
    if _position(shared, job) < 0 or job.repeats_done or job.rest_s or _keeps(shared):
        return True
    worker = _who_is_at(floor, job)
    if worker:
        operation_over(floor, job, worker)
    else:
        operation_done(floor, job)
    return False


@step
def note(floor: Floor, shared: Shared, job: Job) -> bool:
    """The operation is done here: so much of the shared work is too."""
    _note(floor, shared, job, _position(shared, job))
    return True


@step
def pass_over(floor: Floor, shared: Shared, job: Job) -> bool:
    """At the partner, what was done before is not done again."""
    if not (job.task_position or job.repeats_done or job.rest_s):
        job.task_position = shared.n
        if job.block.shared and job.block.shared[shared.number]:
            job.task_position = job.block.shared[shared.number] - 1
    return True


@step
def all_done(floor: Floor, shared: Shared, job: Job) -> bool:
    """The partner has done the rest; a job that is reworked there gets the partner's own work alone."""
    _note(floor, shared, job, shared.n)
    return True


def install(build: Any) -> None:
    """Stations that share work: the partner can do the shared tasks too, before its own."""
    shares = build.plan.shares
    for number, plan in enumerate(shares):
        build.keep_jobs()
        station, partner = build.stations[plan.station], build.stations[plan.partner]
        shared = build.arena.new("Shared")
        shared.number, shared.n_shares, shared.n, shared.filled = number, len(shares), len(plan.tasks), plan.filled
        shared.station, shared.partner = station, partner
        _give(build, plan.tasks, partner)
        build.hang(station.readies, before_task, shared, FIRST)
        build.hang(station.afters, note, shared, FIRST)
        build.hang(partner.readies, pass_over, shared, FIRST)
        build.hang(partner.afters, all_done, shared, FIRST)


def _give(build: Any, ranks: Any, partner: Any) -> None:
    """The shared tasks come before the partner's own."""
    own = [partner.tasks[i] for i in range(partner.n_tasks)]
    own_per_lot = [partner.per_lot[i] for i in range(partner.n_tasks)]
    build.set_tasks(partner, (*ranks, *own))
    partner.per_lot = build.ints((*(build.plan.tasks[rank].per_lot for rank in ranks), *own_per_lot))
