"""Overtime: who stays on after his shift while jobs on the floor need him, and nobody whose shift it is."""

from dataclasses import dataclass

from opsim.engine.simpy_engine.andon import LINES
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.presence import DUTY
from opsim.engine.simpy_engine.reach import Reach, held_up, lasts
from opsim.engine.simpy_engine.state import CREWS, OUTSIDE, Job, Station, Worker
from opsim.engine.simpy_engine.ties import Ties
from opsim.log import HELD
from opsim.plan.calendar import next_open


@dataclass(frozen=True, slots=True)
class Staff:
    """The others. on_duty : whose shift it is; there : who is there, in overtime too

    jobs_of_gone : the jobs that wait each for somebody who is gone: nobody else serves them
    """

    on_duty: list[Worker]
    there: list[Worker]
    jobs_of_gone: set[Job]


class Needs:
    """at_once : by station, how many workers its tasks take at most; 0 where it works alone; reach : of jobs"""

    def __init__(self, floor: Floor):
        self.at_once = [_at_once(floor, station) for station in floor.stations]
        self.reach = Reach(floor)

    def need(self, floor: Floor, worker: Worker, staff: Staff, until_s: float, ties: Ties) -> bool:
        """Whether a job on the floor comes until a time to where he can do something, and too few on duty can."""
        own = ties.job_of.get(worker.rank)
        if own is not None and own.kind == HELD and _opens_before(floor, own.station, until_s):
            return True
        lacking = self._lacking(floor, worker, staff.on_duty, until_s)
        if not lacking:
            return False
        to_carry = {own, *(claim[3] for claim in ties.left)}
        if worker.job is not None and worker.job.held_by is worker and worker.job.plan.carried:
            to_carry.add(worker.job)
        if any(job is not None and lacking >> job.station.rank & 1 for job in to_carry):
            return True
        left = ~held_up(floor, until_s)
        comes = self.reach.of(lacking & left, self._passed(floor, [worker, *staff.there], until_s) & left)
        return any(
            comes[job.product][job.step]
            and job.station is not OUTSIDE
            and job not in staff.jobs_of_gone
            and not lasts(job, until_s)
            for job in floor.jobs.values()
        )

    def _passed(self, floor: Floor, there: list[Worker], until_s: float) -> int:
        """The stations, as bits, that jobs get through: by themselves, or since enough are there who can serve them."""
        skills = [worker.skills_but_for(DUTY, CREWS, LINES) for worker in there]
        return sum(
            1 << station.rank
            for station, n in zip(floor.stations, self.at_once)
            if sum(bits >> station.rank & 1 for bits in skills) >= n and _opens_before(floor, station, until_s)
        )

    def _lacking(self, floor: Floor, worker: Worker, on_duty: list[Worker], until_s: float) -> int:
        """The stations, as bits, where he may be sent or called, and fewer of the others than their tasks take."""
        mine = worker.skills_but_for(DUTY, CREWS, LINES)
        others = [other.skills_but_for(DUTY, CREWS) for other in on_duty]
        lacking = 0
        for station in floor.stations:
            rank = station.rank
            if mine >> rank & 1 and self.at_once[rank] and _opens_before(floor, station, until_s):
                lacking |= (sum(skills >> rank & 1 for skills in others) < self.at_once[rank]) << rank
        return lacking


def _at_once(floor: Floor, station: Station) -> int:
    tasks = [floor.plan.tasks[task] for task in station.tasks]
    return max((task.team for task in tasks if not task.automatic), default=0)


def _opens_before(floor: Floor, station: Station, until_s: float) -> bool:
    """Whether it is open, or will be before a time."""
    open_s = station.plan.open_s
    return open_s is None or next_open(open_s, floor.now) < until_s
