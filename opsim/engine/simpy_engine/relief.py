"""Hand-over: who has to go works on until somebody free has come and takes over."""

from __future__ import annotations

from dataclasses import dataclass

from opsim.engine.rules.duty import first_relief
from opsim.engine.simpy_engine.allocation import on_round, send
from opsim.engine.simpy_engine.floor import Floor, pair_key
from opsim.engine.simpy_engine.interruption import take_over
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import SETUP, WORK

ORDER = 40
"""Among the ways to begin a task: after the way along a moving line, so that he takes over where the job is."""


@dataclass(slots=True, eq=False)
class Relief:
    """Somebody is to take over a job from a worker since a time; taker : who is on his way."""

    leaver: Worker
    job: Job
    since_s: float
    taker: Worker | None = None

    def may_begin(self, now: float) -> bool:
        """Whether there is something to take over: he is at work, and is not done at this very instant."""
        job = self.job
        at_work = job.worker == self.leaver.rank and self.leaver.job is job and job.kind in (WORK, SETUP)
        return at_work and job.since_s + job.duration_s > now


class Reliefs:
    """asked : by the rank of who wants to go; coming : by the rank of who is on his way."""

    def __init__(self, floor: Floor):
        self.asked: dict[int, Relief] = {}
        self.coming: dict[int, Relief] = {}
        floor.left_station.append(self.job_gone)
        for station in floor.stations:
            station.add_act(ORDER, self.met)

    def ask(self, floor: Floor, leaver: Worker, job: Job) -> None:
        """Somebody is wanted."""
        self.asked[leaver.rank] = Relief(leaver, job, floor.now)

    def drop(self, leaver: Worker) -> None:
        """Nobody is wanted any more; who is on his way comes all the same, and is free there."""
        relief = self.asked.pop(leaver.rank, None)
        if relief is not None and relief.taker is not None:
            self.coming.pop(relief.taker.rank, None)
            if relief.taker.job is relief.job:  # else he was stopped on his way along a moving line
                relief.taker.job = None

    def job_gone(self, _floor: Floor, job: Job, _station: Station) -> None:
        """The job has left its station."""
        for relief in [relief for relief in self.asked.values() if relief.job is job] if self.asked else ():
            self.drop(relief.leaver)

    def turns_back(self, taker: Worker) -> bool:
        """Who was on his way has to go himself, and another one is wanted; False where he was not."""
        relief = self.coming.pop(taker.rank, None)
        if relief is None:
            return False
        relief.taker = taker.job = None
        return True

    def send(self, floor: Floor) -> bool:
        """Send who is free and can do it, by the rule of allocation; True where somebody goes."""
        sent = False
        for relief in sorted(self.asked.values(), key=lambda one: first_relief(one.since_s, one.leaver.rank)):
            if relief.leaver.job is not relief.job:
                self.drop(relief.leaver)
            elif relief.taker is None and relief.may_begin(floor.now):
                taker = _best(floor, relief)
                if taker is not None:
                    relief.taker, self.coming[taker.rank] = taker, relief
                    send(floor, taker, relief.job.station, relief.job)
                    sent = True
        return sent

    def met(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody has come to take over, and does, or there is nothing left to take over; False where he had not."""
        relief = self.coming.pop(worker.rank, None) if self.coming else None
        if relief is None:
            return False
        relief.taker = None
        if relief.job is not job:  # he was stopped on his way along a moving line, and sent elsewhere
            return False
        worker.since_s = floor.now  # what he did until now is written
        if relief.may_begin(floor.now):
            del self.asked[relief.leaver.rank]
            take_over(floor, job, worker)
        else:
            set_free(floor, worker)
        return True


def _best(floor: Floor, relief: Relief) -> Worker | None:
    """Who comes; None where nobody can."""
    station, job = relief.job.station, relief.job
    able = [worker for worker in floor.free.values() if worker.may_serve(station)]
    if floor.plan.idle == "patrol":
        able = [worker for worker in able if on_round(worker, station)]
    n_waiting = 1 + len(station.queue)

    def key(worker: Worker) -> tuple[float, ...]:
        return pair_key(floor, worker, station, job, n_waiting, relief.since_s)

    return min(able, key=key, default=None)
