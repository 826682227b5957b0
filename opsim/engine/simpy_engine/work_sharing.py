"""Work sharing: the last tasks of a station are done there, or first at the next one, as the job comes to them."""

from __future__ import annotations

from opsim.engine.rules.work_sharing import keeps_shared
from opsim.engine.simpy_engine.completion import operation_over
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import operation_done
from opsim.engine.simpy_engine.state import Job, Station
from opsim.log import WALK
from opsim.plan.work_sharing import SharePlan

FIRST = 0
"""Among what is asked before each task, and when an operation is done: a task is looked at when it is to be done."""


class _Shared:
    """The work that two stations share. done : by job number, how much of it was done at the first of them."""

    def __init__(self, plan: SharePlan, station: Station, partner: Station):
        self.plan, self.station, self.partner = plan, station, partner
        self.n = len(plan.tasks)
        self.done: dict[int, int] = {}

    def before_task(self, floor: Floor, job: Job) -> bool:
        """Whether the job stays for its next task; where it is left to the partner, it is done here, and goes on."""
        if self._position(job) < 0 or job.repeats_done or job.rest_s or self._keeps():
            return True
        worker = next((w for w in floor.workers if w.job is job and w.kind != WALK and w.rank not in floor.free), None)
        if worker is None:
            operation_done(floor, job)
        else:
            operation_over(floor, job, worker)
        return False

    def note(self, _floor: Floor, job: Job) -> bool:
        """The operation is done here: so much of the shared work is too."""
        self.done[job.number] = self._position(job)
        return True

    def pass_over(self, _floor: Floor, job: Job) -> bool:
        """At the partner, what was done before is not done again."""
        if not (job.task_position or job.repeats_done or job.rest_s):
            job.task_position = self.done.get(job.number, self.n)
        return True

    def all_done(self, _floor: Floor, job: Job) -> bool:
        """The partner has done the rest; a job that is reworked there gets the partner's own work alone."""
        self.done[job.number] = self.n
        return True

    def forget(self, _floor: Floor, job: Job) -> None:
        self.done.pop(job.number, None)

    def _position(self, job: Job) -> int:
        """Which of the shared tasks the job has come to; below 0: none of them yet."""
        return job.task_position - (len(self.station.tasks) - self.n)

    def _keeps(self) -> bool:
        partner = self.partner
        n_inside = partner.n_inside - len(partner.put_away)
        return keeps_shared(n_inside, partner.plan.servers, partner.plan.buffer, self.plan.filled)


def install(floor: Floor) -> None:
    """Stations that share work: the partner can do the shared tasks too, before its own."""
    for plan in floor.plan.shares:
        station, partner = floor.stations[plan.station], floor.stations[plan.partner]
        shared = _Shared(plan, station, partner)
        _give(floor, plan, partner)
        station.add_ready(FIRST, shared.before_task)
        station.add_after(FIRST, shared.note)
        partner.add_ready(FIRST, shared.pass_over)
        partner.add_after(FIRST, shared.all_done)
        floor.left_floor.append(shared.forget)


def _give(floor: Floor, share: SharePlan, partner: Station) -> None:
    """The shared tasks come before the partner's own."""
    tasks = [floor.plan.tasks[task] for task in share.tasks]
    partner.tasks = (*share.tasks, *partner.tasks)
    partner.automatic = (*(task.automatic for task in tasks), *partner.automatic)
    partner.repeats = (*(task.repeat for task in tasks), *partner.repeats)
    partner.per_lot = (*(task.per_lot for task in tasks), *partner.per_lot)
