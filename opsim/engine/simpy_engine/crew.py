"""A crew: who has which job in hand, who goes back for which, and who waits behind whom."""

from __future__ import annotations

from opsim.engine.rules.crews import takes_over, takes_up
from opsim.engine.simpy_engine.allocation import send
from opsim.engine.simpy_engine.crew_hands import (
    caught_up,
    is_stuck,
    let_go,
    must_stay,
    put_down,
    stands_behind,
    stays_with,
    waits,
)
from opsim.engine.simpy_engine.crew_line import CrewLine
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import move_on
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.engine.simpy_engine.worker import log_worker, walk
from opsim.log import ABSENT, BEHIND, BREAK, HELD, IDLE, NO_WORKER, OFF, WALK
from opsim.plan.crews import BUCKET_BRIGADE, CrewPlan

AWAY_KINDS = (BREAK, OFF, ABSENT)
LEAVES = "duty"
"""The limit of somebody who is about to go, or is just back."""


class Crew:
    """hand : by member, the job he has; goal : the one he walks to; stand : the station of the line where he is, or

    was last, by its number; None: he comes from elsewhere
    done_here : jobs that are done at a station, and wait there for who is ahead of them, or for who takes them on
    """

    def __init__(self, floor: Floor, plan: CrewPlan):
        self.plan, self.line = plan, CrewLine(floor, plan.stations)
        self.is_brigade = plan.kind == BUCKET_BRIGADE
        self.stations = [floor.stations[rank] for rank in plan.stations]
        self.members = [floor.workers[rank] for rank in plan.workers]
        self.hand: list[Job | None] = [None] * len(self.members)
        self.goal: list[Job | None] = [None] * len(self.members)
        self.stand: list[int | None] = [None] * len(self.members)
        self.done_here: list[Job] = []

    def done(self, floor: Floor, job: Job) -> bool:
        """Whether a job that is done at a station leaves it: nobody ahead of it is still there, or comes to take it."""
        comes = self._comes_soon(job)
        if not comes and self.line.may_leave(job):
            return True
        floor.job_now(job, HELD, NO_WORKER if comes else BEHIND)
        self.done_here.append(job)
        if comes:
            self._drop(floor, job)
        return False

    def _comes_soon(self, job: Job, after: int = -1) -> bool:
        """Whether somebody is on his last way to a job, of those who come after a member."""
        return any(
            self.goal[member] is job and worker.kind == WALK and worker.place == job.station.place
            for member, worker in enumerate(self.members[after + 1 :], after + 1)
        )

    def dispatch(self, floor: Floor) -> bool:
        """Everybody who is free goes on with his job, takes one, or goes to where he may find one."""
        self.line.tidy()
        self._forget(floor)
        changed = self._let_on(floor)
        for member in self._in_turn():
            worker = self.members[member]
            if LEAVES not in worker.limits and self._next(floor, member, worker):
                changed = True
            stands_behind(floor, worker, self.line.gates)
        return changed

    def _in_turn(self) -> list[int]:
        """Members in the order in which they are asked: the last of a brigade first; else who is nearest the start."""
        everybody = range(len(self.members))
        if self.is_brigade:
            return list(reversed(everybody))
        first = self.stations[0].rank
        return sorted(everybody, key=lambda member: self.members[member].walk_s[self.members[member].place][first])

    def _forget(self, floor: Floor) -> None:
        """Jobs that have left the line are in nobody's hands; who is away has let go of his."""
        there = self.line.jobs
        self.done_here = [job for job in self.done_here if job.number in floor.jobs and job in there]
        for member, worker in enumerate(self.members):
            away = worker.kind in AWAY_KINDS and worker.rank not in floor.free
            if away or self.hand[member] not in there:
                self.hand[member] = None
            if away or self.goal[member] not in there:
                self.goal[member] = None
            if away:
                self.stand[member] = None

    def _let_on(self, floor: Floor) -> bool:
        """Jobs that are done at their station go on, where nobody is in their way any more."""
        going = [job for job in self.done_here if job not in self.goal and self.line.may_leave(job)]
        for job in going:
            self.done_here.remove(job)
            move_on(floor, job)
        return bool(going)

    def _next(self, floor: Floor, member: int, worker: Worker) -> bool:
        """What a free member does next. True where something changed."""
        if (job := self.hand[member]) is not None and self._waits_for_nobody(job):
            put_down(floor, job)
            job = self.hand[member] = None
        if worker.rank not in floor.free:
            return False
        self.goal[member] = None
        if job is None:
            job = self._wanted(member)
            if job is None:
                return self._to_the_start(floor, member, worker)
            if not self._reaches(floor, member, worker, job):
                return False
            if not caught_up(floor, job):
                waits(floor, worker, BEHIND)
                return False
            self._drop(floor, job)
            let_go(floor, job)
            self.hand[member] = job
            self._goes_on(floor, member, worker, job)
            return True
        return self._goes_on(floor, member, worker, job)

    def _waits_for_nobody(self, job: Job) -> bool:
        """Whether a job waits for one that nobody sees to: who has it does better to see to that himself."""
        if not is_stuck(job, self.done_here):
            return False
        ahead = self.line.ahead(job)
        return ahead is not None and self._holder(ahead) < 0 and ahead not in self.goal

    def _goes_on(self, floor: Floor, member: int, worker: Worker, job: Job) -> bool:
        """Somebody with a job in his hands is sent to it where it calls; else he stays by it and waits."""
        station = job.station
        if self._comes_soon(job, member):
            self._drop(floor, job)
            return True
        if any(claim[3] is job for claim in station.calling):
            self.stand[member] = self.line.at(job)
            send(floor, worker, station, job)
            return True
        if must_stay(floor, job):
            if self._reaches(floor, member, worker, job):
                stays_with(floor, worker, job)
                return True
            return False
        waits(floor, worker, BEHIND if is_stuck(job, self.done_here) else IDLE)
        return False

    def _wanted(self, member: int) -> Job | None:
        """The job that a member without one goes for: of those he may have, the one that is furthest on."""
        may_take = takes_over if self.is_brigade else takes_up
        jobs = self.line.jobs
        holders = [max(self._holder(job), self._comer(job)) for job in jobs]
        first = max((n + 1 for n, holder in enumerate(holders) if holder > member), default=0) if self.is_brigade else 0
        return next((job for job, holder in zip(jobs[first:], holders[first:]) if may_take(member, holder)), None)

    def _holder(self, job: Job) -> int:
        return next((member for member, own in enumerate(self.hand) if own is job), -1)

    def _comer(self, job: Job) -> int:
        """The last member who is on his way to a job."""
        return max((member for member, goal in enumerate(self.goal) if goal is job), default=-1)

    def _drop(self, _floor: Floor, job: Job) -> None:
        self.hand = [None if own is job else own for own in self.hand]

    def _to_the_start(self, floor: Floor, member: int, worker: Worker) -> bool:
        """Who finds nothing to do goes to the first station."""
        if self._goes_to(floor, member, worker, 0):
            first = self.stations[0]
            wanted = first.queue or floor.saturated or any(gate.claims for gate in first.wanted_by)
            waits(floor, worker, BEHIND if wanted and not first.free_servers else IDLE)
        return False

    def _reaches(self, floor: Floor, member: int, worker: Worker, job: Job) -> bool:
        """Whether a member stands where a job is; else he goes there, or a part of the way."""
        if self._goes_to(floor, member, worker, self.line.at(job)):
            return True
        self.goal[member] = job
        return False

    def _goes_to(self, floor: Floor, member: int, worker: Worker, to: int) -> bool:
        """Whether a member is at a station of the line; else he sets out: in a brigade only as far as the next one."""
        at = self.stand[member]
        while worker.place != self.stations[to].place or at != to:
            step = to if at is None or not self.is_brigade else at + (to > at) - (to < at)
            station = self.stations[step]
            self.stand[member] = at = step
            walk_s = worker.walk_s[worker.place][station.rank]
            if walk_s > 0:
                log_worker(floor, worker)
                del floor.free[worker.rank]
                walk(floor, worker, station.place, walk_s)
                return False
            worker.place = station.place
        return True
