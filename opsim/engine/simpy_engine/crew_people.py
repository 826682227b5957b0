"""The members of a crew: what each has in his hands, what he walks to, and where along the line he is."""

from __future__ import annotations

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.presence import DUTY
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.worker import log_worker, walk
from opsim.log import ABSENT, BREAK, OFF, WALK

AWAY_KINDS = (BREAK, OFF, ABSENT)


class CrewPeople:
    """Each list by the number of a member along the line.

    hand  : the job he has, on which he works, or by which he waits; goal : the one he walks to
    stand : the number of the station of the line where he is, or was last; None: he comes from elsewhere
    along : whether they walk station by station
    """

    __slots__ = ("along", "goal", "hand", "members", "stand", "stations")

    def __init__(self, members: list[Worker], stations: list[Station], along: bool):
        self.members, self.stations, self.along = members, stations, along
        self.hand: list[Job | None] = [None] * len(members)
        self.goal: list[Job | None] = [None] * len(members)
        self.stand: list[int | None] = [None] * len(members)

    def tidy(self, floor: Floor, line: list[Job]) -> None:
        """Jobs that have left the line are in nobody's hands; who is away has let go of his."""
        for member, worker in enumerate(self.members):
            away = _is_away(floor, worker)
            if away or self.hand[member] not in line:
                self.hand[member] = None
            if away or self.goal[member] not in line:
                self.goal[member] = None
            if away:
                self.stand[member] = None

    def holder(self, job: Job) -> int:
        """Who has a job; -1: nobody."""
        return next((member for member, own in enumerate(self.hand) if own is job), -1)

    def comer(self, job: Job) -> int:
        """The last member who is on his way to a job; -1: nobody is."""
        return max((member for member, goal in enumerate(self.goal) if goal is job), default=-1)

    def comes_soon(self, job: Job, after: int = -1) -> bool:
        """Whether somebody is on his last way to a job, or waits there for it, of those who come after a member."""
        return any(
            self.goal[member] is job and worker.place == job.station.place
            for member, worker in enumerate(self.members[after + 1 :], after + 1)
        )

    def drop(self, job: Job) -> None:
        """Nobody has the job any more."""
        self.hand = [None if own is job else own for own in self.hand]

    def reaches(self, floor: Floor, member: int, job: Job, place: int) -> bool:
        """Whether a free member stands where a job is; else he goes there, or a part of the way."""
        if self.goes_to(floor, member, place):
            return True
        self.goal[member] = job
        return False

    def goes_to(self, floor: Floor, member: int, place: int) -> bool:
        """Whether a free member is at a station of the line; else he sets out, along it only as far as the next one."""
        worker, at = self.members[member], self.stand[member]
        while worker.place != self.stations[place].place or at != place:
            step = place if at is None or not self.along else at + (place > at) - (place < at)
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


def _is_away(floor: Floor, worker: Worker) -> bool:
    """Whether somebody is off, absent or resting, or walks and will be: only what he carries is still his."""
    if worker.kind == WALK:
        return worker.job is None and DUTY in worker.limits
    return worker.kind in AWAY_KINDS and worker.rank not in floor.free
