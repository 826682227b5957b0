"""Defects are left, found or missed; what is turned down is scrapped, or goes back for rework."""

from collections import Counter

from opsim.engine.rules.quality import leaves_defect, reworked, share_of_good, turned_down
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.human_errors import share_of_good_by
from opsim.engine.simpy_engine.material import go_to, leave_floor, leave_station, withdraw
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.log import BAD, FALSE_ALARM, REWORK, SCRAP
from opsim.plan.quality import NOWHERE, QualityPlan

ORDER = 10
"""Among what is asked when an operation is done."""
ACT = 45
"""Among the ways to begin a task: after those who do not begin it yet, or take over."""


def install(floor: Floor) -> None:
    """A look at each job at the stations where something goes wrong, or is looked at."""
    if not floor.plan.quality:
        return
    counted = _Counted()
    floor.left_floor.append(counted.forget)
    for plan in floor.plan.quality:
        station, gauge = floor.stations[plan.station], _Gauge(plan, counted)
        station.add_after(ORDER, gauge)
        if plan.by_worker:
            station.add_act(ACT, gauge.note)
            floor.left_floor.append(gauge.forget)


class _Counted:
    """How often each job on the floor was through an operation, and reworked from a station."""

    def __init__(self) -> None:
        self.passes: dict[int, dict[int, int]] = {}
        self.reworks: dict[int, Counter[int]] = {}

    def visit(self, job: Job) -> int:
        """How often the job was through its operation before."""
        passes = self.passes.get(job.number)
        if passes is None:
            passes = self.passes[job.number] = {}
        before = passes.get(job.operation_rank, 0)
        passes[job.operation_rank] = before + 1
        return before

    def forget(self, _floor: Floor, job: Job) -> None:
        self.passes.pop(job.number, None)
        self.reworks.pop(job.number, None)


class _Gauge:
    """What becomes of a job whose operation at a station is done: True where it goes on as its way leads."""

    def __init__(self, plan: QualityPlan, counted: _Counted):
        self.plan, self.counted = plan, counted
        self.worst: dict[int, float] = {}

    def __call__(self, floor: Floor, job: Job) -> bool:
        plan, visit = self.plan, self.counted.visit(job)
        where = job.operation.name, floor.plan.sources[job.source].name, visit
        good = share_of_good(plan.yield_share, self.worst.pop(job.number, 1.0)) if plan.by_worker else plan.yield_share
        if good < 1 and leaves_defect(floor.draws.chance(("yield", *where), job.n), good):
            job.bad = True
        if not plan.inspects:
            return True
        chance = floor.draws.chance(("quality", *where), job.n) if _is_open(plan, job.bad) else 0.0
        if not turned_down(chance, job.bad, plan.finds, plan.false_alarms):
            return True
        self.turn_down(floor, job, BAD if job.bad else FALSE_ALARM)
        return False

    def note(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody works on the job, and on those that are with it: of several, the worst counts. Never sees to it."""
        station, qualities = job.station, worker.plan.quality
        if station.down or job.setup_task >= 0:
            return False
        good = (qualities[station.rank] if qualities else 1.0) * share_of_good_by(floor, worker)
        if good < 1:
            for one in (job, *job.members):
                self.worst[one.number] = min(self.worst.get(one.number, 1.0), good)
        return False

    def forget(self, _floor: Floor, job: Job) -> None:
        self.worst.pop(job.number, None)

    def turn_down(self, floor: Floor, job: Job, cause: int) -> None:
        """The job goes back, or is scrapped."""
        station = job.station
        if job.ahead is not None:
            withdraw(floor, job)
        back = self.plan.back[job.product][job.step] if self.plan.back else NOWHERE
        reworks = self.counted.reworks.setdefault(job.number, Counter())
        if back == NOWHERE or not reworked(reworks[station.rank], self.plan.most):
            leave_station(floor, job)
            leave_floor(floor, job, SCRAP, cause, station.rank)
            return
        reworks[station.rank] += 1
        floor.log_instant(REWORK, job, cause, station.rank)
        job.bad = False
        go_to(floor, job, back)


def _is_open(plan: QualityPlan, bad: bool) -> bool:
    """Whether an inspection of such a job may end either way."""
    return 0 < (plan.finds if bad else plan.false_alarms) < 1
