"""A crew: who takes which job, who goes back for which, and who waits behind whom."""

from __future__ import annotations

from opsim.engine.rules.crews import takes_over, takes_up
from opsim.engine.simpy_engine.allocation import send
from opsim.engine.simpy_engine.crew_hands import (
    caught_up,
    is_stuck,
    must_stay,
    put_down,
    stands_behind,
    stays_with,
    takes_on,
    waits,
)
from opsim.engine.simpy_engine.crew_line import CrewLine
from opsim.engine.simpy_engine.crew_people import CrewPeople
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import move_on
from opsim.engine.simpy_engine.presence import DUTY
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.log import BEHIND, HELD, IDLE, NO_WORKER
from opsim.plan.crews import BUCKET_BRIGADE, CrewPlan


class Crew:
    """done_here : jobs that are done at a station, and wait there for who is ahead of them, or for who takes them on"""

    __slots__ = ("done_here", "is_brigade", "line", "people", "stations")

    def __init__(self, floor: Floor, plan: CrewPlan):
        self.is_brigade = plan.kind == BUCKET_BRIGADE
        self.line = CrewLine(floor, plan.stations)
        self.stations = [floor.stations[rank] for rank in plan.stations]
        self.people = CrewPeople([floor.workers[rank] for rank in plan.workers], self.stations, self.is_brigade)
        self.done_here: list[Job] = []

    def done(self, floor: Floor, job: Job) -> bool:
        """Whether a job that is done at a station leaves it: nobody ahead of it is still there, or comes to take it."""
        comes = self.people.comes_soon(job)
        if not comes and self.line.may_leave(job):
            return True
        floor.job_now(job, HELD, NO_WORKER if comes else BEHIND)
        self.done_here.append(job)
        if comes:
            self.people.drop(job)
        return False

    def dispatch(self, floor: Floor) -> bool:
        """Everybody who is free goes on with his job, takes one, or goes to where he may find one."""
        self.line.tidy()
        self.people.tidy(floor, self.line.jobs)
        self.done_here = [job for job in self.done_here if job in self.line.jobs]
        changed = self._let_on(floor)
        for member in self._in_turn():
            worker = self.people.members[member]
            if DUTY not in worker.limits and self._next(floor, member, worker):
                changed = True
            stands_behind(floor, worker, self.line.gates)
        return changed

    def _in_turn(self) -> list[int]:
        """Members in the order in which they are asked: the last of a brigade first; else who is nearest the start."""
        members, first = self.people.members, self.stations[0].rank
        if self.is_brigade:
            return list(reversed(range(len(members))))
        return sorted(range(len(members)), key=lambda member: members[member].walk_s[members[member].place][first])

    def _let_on(self, floor: Floor) -> bool:
        """Jobs that are done at their station go on, where nobody is in their way any more."""
        going = [job for job in self.done_here if job not in self.people.goal and self.line.may_leave(job)]
        for job in going:
            self.done_here.remove(job)
            move_on(floor, job)
        return bool(going)

    def _next(self, floor: Floor, member: int, worker: Worker) -> bool:
        """What a member does next, where he is free or only waits. True where something changed."""
        people = self.people
        job = people.hand[member]
        if job is not None and self._waits_for_nobody(job):
            put_down(floor, job)
            job = people.hand[member] = None
        if worker.rank not in floor.free:
            return False
        people.goal[member] = None
        return self._goes_on(floor, member, worker, job) if job is not None else self._looks(floor, member, worker)

    def _waits_for_nobody(self, job: Job) -> bool:
        """Whether a job waits for one that nobody sees to: who has it does better to see to that himself."""
        if not is_stuck(job, self.done_here):
            return False
        ahead = self.line.ahead(job)
        return ahead is not None and self.people.holder(ahead) < 0 and self.people.comer(ahead) < 0

    def _looks(self, floor: Floor, member: int, worker: Worker) -> bool:
        """A member without a job takes one where he meets it, or goes there. True where something changed."""
        job = self._wanted(member)
        if job is None:
            return self._to_the_start(floor, member, worker)
        if not self.people.reaches(floor, member, job, self.line.at(job)):
            return False
        if not caught_up(floor, job):
            waits(floor, worker, BEHIND)
            self.people.goal[member] = job
            return False
        self.people.drop(job)
        self.people.hand[member] = job
        takes_on(floor, worker, job)
        if worker.rank in floor.free:
            self._goes_on(floor, member, worker, job)
        return True

    def _goes_on(self, floor: Floor, member: int, worker: Worker, job: Job) -> bool:
        """Somebody with a job in his hands is sent to it where it calls; else he stays by it and waits."""
        if self.people.comes_soon(job, member):
            self.people.drop(job)
            return True
        if any(claim[3] is job for claim in job.station.calling):
            self.people.stand[member] = self.line.at(job)
            send(floor, worker, job.station, job)
            return True
        if must_stay(floor, job):
            if self.people.reaches(floor, member, job, self.line.at(job)):
                stays_with(floor, worker, job)
                return True
            return False
        waits(floor, worker, BEHIND if is_stuck(job, self.done_here) else IDLE)
        return False

    def _wanted(self, member: int) -> Job | None:
        """The job that a member without one goes for: of those he may have, the one that is furthest on."""
        jobs = self.line.jobs
        holders = [max(self.people.holder(job), self.people.comer(job)) for job in jobs]
        if not self.is_brigade:
            return next((job for job, holder in zip(jobs, holders) if takes_up(member, holder)), None)
        behind = max((number + 1 for number, holder in enumerate(holders) if holder > member), default=0)
        mine = zip(jobs[behind:], holders[behind:])
        return next((job for job, holder in mine if takes_over(member, holder)), None)

    def _to_the_start(self, floor: Floor, member: int, worker: Worker) -> bool:
        """Who finds nothing to do goes to the first station, and waits there for a job, or for a free server."""
        if self.people.goes_to(floor, member, 0):
            first = self.stations[0]
            wanted = first.queue or floor.saturated or any(gate.claims for gate in first.wanted_by)
            waits(floor, worker, BEHIND if wanted and not first.free_servers else IDLE)
        return False
