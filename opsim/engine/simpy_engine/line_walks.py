"""Where workers stand on a moving line: they walk with their jobs, and back to the next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from opsim.clock import STEP_S, on_grid
from opsim.engine.rules import COMPLETION
from opsim.engine.rules.lines import INFINITE_S, meeting_s, strolled_m
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.engine.simpy_engine.worker import log_worker, set_free, stop
from opsim.log import IDLE, WAIT, WALK

ORDER = 30
"""Among the ways to begin a task: a worker comes to his job first."""
STROLLED = "back at the beginning of a stretch"


@dataclass(frozen=True, slots=True, eq=False)
class Spot:
    """A worker who is at no job, at a station of some place.

    from_m, since_s : where he was, and when; to_m : where he may begin there; strolls : whether he walks back to it
    """

    worker: Worker
    place: int
    from_m: float
    to_m: float
    since_s: float
    strolls: bool = False

    def at_m(self, now: float) -> float:
        """Where he is."""
        if not self.strolls:
            return self.from_m
        return strolled_m(self.from_m, self.to_m, self.worker.plan.walk_m_per_s, now - self.since_s)

    @property
    def back_s(self) -> float:
        """How long he walks back."""
        return (self.from_m - self.to_m) / self.worker.plan.walk_m_per_s


@dataclass(frozen=True, slots=True)
class Way:
    """A worker on his way along the line to a job at the at-th station: he was at from_m at since_s.

    downstream : which way he walks
    """

    job: Job
    at: int
    from_m: float
    since_s: float
    downstream: bool


class LineWalks:
    """By the rank of a worker: with : the job he is at, when that came onto the line, and the how many-th station it is

    spots : where he is who is at none; ways : who walks to one
    """

    def __init__(self, floor: Floor, line: Any):
        self.line, self.plan = line, line.plan
        self.with_job: dict[int, tuple[Job, float, int]] = {}
        self.spots: dict[int, Spot] = {}
        self.ways: dict[int, Way] = {}
        for station in line.stations:
            station.add_act(ORDER, self.act)
        floor.dispatchers.append(self.look)

    def act(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody is to begin: True where he has to walk to the job first."""
        rank, began_s = worker.rank, self.line.began_s[job.number]
        at = self.line.at[job.station.rank]
        mine, way = self.with_job.get(rank), self.ways.pop(rank, None)
        if mine is not None and mine[0] is job and mine[2] == at:
            return False
        there_m = self.line.job_m(began_s, floor.now)
        if way is None or way.job is not job:
            here_m = self._where_m(floor, worker, at)
            if self._meeting_s(worker, there_m - here_m) > STEP_S:
                worker.kind, worker.since_s, worker.walk_from = WALK, floor.now, worker.place
                self._walk(floor, worker, Way(job, at, here_m, floor.now, there_m > here_m), there_m - here_m)
                return True
        self.spots.pop(rank, None)
        self.with_job[rank] = job, began_s, at
        return False

    def stop(self, floor: Floor, job: Job, but: int = -1) -> None:
        """Nobody, but for one, is to walk to a job any more: whoever does is free where he is."""
        for rank, way in list(self.ways.items()):
            if way.job is job and rank != but:
                self._stop(floor, rank, way)

    def look(self, floor: Floor) -> bool:
        """Who has left his job stands where it is now, and walks back while nobody sends him."""
        for rank, (job, began_s, at) in list(self.with_job.items()) if self.with_job else ():
            worker = floor.workers[rank]
            if worker.job is not job:
                del self.with_job[rank]
                self._stand(worker, at, self.line.job_m(began_s, floor.now), floor.now)
        for rank, way in list(self.ways.items()) if self.ways else ():
            if floor.workers[rank].job is not way.job:  # the job calls for somebody else, since he has to go
                self._stop(floor, rank, way)
        for rank, spot in list(self.spots.items()) if self.spots else ():
            worker = spot.worker
            if worker.place != spot.place:
                del self.spots[rank]
            elif spot.strolls and (rank not in floor.free or worker.kind != WALK):
                self.spots[rank] = Spot(worker, spot.place, spot.at_m(floor.now), spot.to_m, floor.now)
            elif not spot.strolls and rank in floor.free and worker.kind == WAIT and spot.back_s > STEP_S:
                self._stroll(floor, spot)
        return False

    def line_changed(self, floor: Floor) -> None:
        """The line has come to stand, or to run: whoever walks to a job meets it at another time."""
        for rank, way in list(self.ways.items()):
            worker = floor.workers[rank]
            here_m = _on_the_way_m(worker, way, floor.now)
            there_m = self.line.job_m(self.line.began_s[way.job.number], floor.now)
            stop(floor, worker)
            self._walk(floor, worker, Way(way.job, way.at, here_m, floor.now, there_m > here_m), there_m - here_m)

    def strolled(self, floor: Floor, spot: Spot) -> None:
        """He is where he may begin, if he was not sent or called away before."""
        worker = spot.worker
        if self.spots.get(worker.rank) is spot and worker.rank in floor.free and worker.kind == WALK:
            log_worker(floor, worker)
            worker.kind, worker.cause, worker.since_s = WAIT, IDLE, floor.now
            self.spots[worker.rank] = Spot(worker, spot.place, spot.to_m, spot.to_m, floor.now)

    def _meeting_s(self, worker: Worker, gap_m: float) -> float:
        speed = self.plan.speed_m_per_s if self.line.clock.runs else 0.0
        return meeting_s(gap_m, worker.plan.walk_m_per_s, speed)

    def _where_m(self, floor: Floor, worker: Worker, at: int) -> float:
        """Where a worker is who stands at a station; who comes from elsewhere is where its stretch begins."""
        mine, spot = self.with_job.pop(worker.rank, None), self.spots.pop(worker.rank, None)
        if mine is not None:
            return self.line.job_m(mine[1], floor.now)
        if spot is not None and spot.place == worker.place:
            return spot.at_m(floor.now)
        return self.plan.start_m[at]

    def _walk(self, floor: Floor, worker: Worker, way: Way, gap_m: float) -> None:
        self.ways[worker.rank] = way
        seconds = self._meeting_s(worker, gap_m)
        if seconds < INFINITE_S:  # else he follows the job until the line stands, or it is sent on
            floor.at_end_of(on_grid(seconds), worker.stretch_over)

    def _stop(self, floor: Floor, rank: int, way: Way) -> None:
        """He walks no further, and is free."""
        worker = floor.workers[rank]
        del self.ways[rank]
        self._stand(worker, way.at, _on_the_way_m(worker, way, floor.now), floor.now)
        stop(floor, worker)
        set_free(floor, worker)

    def _stand(self, worker: Worker, at: int, here_m: float, now: float) -> None:
        """He is at no job any more, on the stretch of a station; elsewhere it does not matter where on the line."""
        if worker.place == self.line.stations[at].place:
            self.spots[worker.rank] = Spot(worker, worker.place, here_m, self.plan.reach_m(at), now)

    def _stroll(self, floor: Floor, spot: Spot) -> None:
        worker = spot.worker
        log_worker(floor, worker)
        worker.kind, worker.since_s, worker.walk_from = WALK, floor.now, worker.place
        begun = Spot(worker, spot.place, spot.from_m, spot.to_m, floor.now, strolls=True)
        self.spots[worker.rank] = begun
        floor.alarm(spot.back_s, COMPLETION, worker.rank, 0, STROLLED, (self, begun))


def _on_the_way_m(worker: Worker, way: Way, now: float) -> float:
    walked_m = worker.plan.walk_m_per_s * (now - way.since_s)
    return way.from_m + (walked_m if way.downstream else -walked_m)


def _strolled(floor: Floor, subject: tuple[LineWalks, Spot]) -> None:
    walks, spot = subject
    walks.strolled(floor, spot)


HANDLERS: dict[str, Handler] = {STROLLED: _strolled}
