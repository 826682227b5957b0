"""The line of a crew: its jobs in their order, in which none overtakes another."""

from __future__ import annotations

from opsim.engine.rules.crews import overtakes
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Claim, Gate, Job, Station
from opsim.log import AFTER, BLOCKED, QUEUE, TRANSPORT


class CrewLine:
    """jobs : on servers of the crew's stations or on their way between them, those that are furthest on first

    place   : of each station's rank, where in the line it is
    carried : numbers of the jobs that somebody carries
    """

    __slots__ = ("carried", "floor", "gates", "jobs", "place")

    def __init__(self, floor: Floor, ranks: tuple[int, ...]):
        self.floor = floor
        self.jobs: list[Job] = []
        self.carried: set[int] = set()
        self.place = {rank: place for place, rank in enumerate(ranks)}
        self.gates = [gate for gate in floor.gates.values() if self._first_place(gate) >= 0]

    def at(self, job: Job) -> int:
        """Where in the line a job is: the number of its station; -1: elsewhere."""
        return self.place.get(job.station.rank, -1)

    def came(self, _floor: Floor, job: Job) -> bool:
        """The job has a server: a preparation that is done at once. Who is new is behind all that are as far on."""
        if job not in self.jobs:
            self.jobs.append(job)
        self.tidy()
        return True

    def tidy(self) -> None:
        """Jobs that have left the line are in it no more. Who has a server is ahead of who is on his way to one there.

        Else jobs keep their order, unless one comes again from the start, or a queue has let it go first.
        """
        there = self.floor.jobs
        jobs = [job for job in self.jobs if job.number in there and self.at(job) >= 0]
        self.jobs = sorted(jobs, key=lambda job: (-self.at(job), _comes(job)))
        carried = {job.number for job in jobs if job.kind == TRANSPORT and job.plan.carried}
        if self.carried - carried:  # somebody has come: who is behind him may set out
            self.floor.stirred.update(gate for gate in self.gates if gate.claims)
        self.carried = carried

    def ahead(self, job: Job) -> Job | None:
        """The job that is next ahead of one in the line; None where there is none, or the job is not in it."""
        before = None
        for other in self.jobs:
            if other is job:
                return before
            if other.number in self.floor.jobs and self.at(other) >= 0:
                before = other
        return None

    def may_leave(self, job: Job) -> bool:
        """Whether a job that is done at a station leaves nobody there who was ahead of it, and is not done."""
        ahead = self.ahead(job)
        return ahead is None or self.at(ahead) > self.at(job) or _is_done(ahead)

    def guard(self) -> None:
        """Have every gate into the line keep the order too, where jobs may skip stations."""
        for gate in self.gates:
            _keep_order(self, gate)
        self.floor.left_station.append(self._stir)

    def may_enter(self, gate: Gate, job: Job) -> bool:
        """Whether a job that comes in by a gate stays behind the one ahead of it, which may still be carried there."""
        ahead = self.ahead(job)
        if ahead is None:
            return True
        place, on_its_way = self._first_place(gate), ahead.kind == TRANSPORT and ahead.plan.carried
        return not overtakes(place + on_its_way, self.at(ahead))

    def _first_place(self, gate: Gate) -> int:
        return min((self.place[s.rank] for s in gate.stations if s.rank in self.place), default=-1)

    def _stir(self, floor: Floor, _job: Job, station: Station) -> None:
        """Who was behind a job that goes on may go on too."""
        if station.rank in self.place:
            floor.stirred.update(gate for gate in self.gates if gate.claims)


def _comes(job: Job) -> bool:
    """Whether a job is on its way to a server, or waits for one."""
    return job.kind == TRANSPORT or (job.kind == QUEUE and job.cause != AFTER)


def _is_done(job: Job) -> bool:
    """Whether a job is done where it is, and wants on."""
    return job.kind == BLOCKED or (job.kind == QUEUE and job.cause == AFTER)


def _keep_order(line: CrewLine, gate: Gate) -> None:
    allows, pick = gate.allows, gate.pick

    def may_enter(job: Job) -> bool:
        return line.may_enter(gate, job) and (allows is None or allows(job))

    def first() -> Claim | None:
        """Cards go by lines of their own: where who they pick has to stay behind, the next one who need not."""
        claim = pick()  # type: ignore[misc]
        if claim is None or line.may_enter(gate, claim[3]):
            return claim
        return next((other for other in gate.claims if gate.may_enter(other[3])), None)

    gate.allows = may_enter
    if pick is not None:
        gate.pick = first
