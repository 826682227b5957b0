"""Andon: somebody is called to a job of a paced line that is not done in time; he takes over, or helps."""

from __future__ import annotations

from bisect import insort
from functools import partial
from typing import Any

from opsim.engine.simpy_engine.allocation import send
from opsim.engine.simpy_engine.floor import Floor, pair_key
from opsim.engine.simpy_engine.helping import can_help, helping_at
from opsim.engine.simpy_engine.interruption import call_again, take_over
from opsim.engine.simpy_engine.sent_on import turn_away
from opsim.engine.simpy_engine.state import Claim, Job, Station, Worker, claim_of
from opsim.engine.simpy_engine.worker import set_free
from opsim.log import AWAY, HELD, NO_WORKER, SETUP, WORK

ORDER = 5
"""Among the ways to begin a task: the first, since who comes to a job that somebody is at begins none."""
LINES = "lines"


class Andon:
    """waiting : jobs for which somebody is wanted; coming : by the rank of who is on his way, the job he goes to

    left_s : when a call was last left to those who work here all the time, once in an instant
    """

    def __init__(self, floor: Floor, line: Any):
        self.line = line
        self.floaters = [floor.workers[rank] for rank in line.plan.floaters]
        self.waiting: list[Claim] = []
        self.coming: dict[int, Job] = {}
        self.left_s = -1.0
        self.helping = helping_at(floor, line.stations) if line.plan.helps else None
        for station in line.stations:
            station.add_act(ORDER, self.act)
        for worker in self.floaters:
            left = worker.limits.get(LINES, (1 << len(floor.stations)) - 1)
            worker.restrict(LINES, left & ~sum(1 << station.rank for station in line.stations))
        floor.dispatchers.append(self.send)

    def call(self, floor: Floor, job: Job) -> None:
        """Somebody is wanted at a job."""
        insort(self.waiting, claim_of(job, floor.now))

    def done(self, floor: Floor, job: Job) -> None:
        """The job is done, or sent on: nobody is wanted, and who is on his way comes all the same."""
        self.waiting = [claim for claim in self.waiting if claim[3] is not job]
        for rank in [rank for rank, other in self.coming.items() if other is job]:
            del self.coming[rank], floor.called[rank]
            worker = self.floaters[self.line.plan.floaters.index(rank)]
            if worker.job is job:
                worker.job = worker.station = None

    def send(self, floor: Floor) -> bool:
        """Send who is free to the jobs that have waited longest; True where somebody goes."""
        sent = False
        for claim in list(self.waiting):
            job, station = claim[3], claim[3].station
            if not self.line.is_open(job):
                self.waiting.remove(claim)
                continue
            able = [one for one in self.floaters if one.rank in floor.free and _may(one, station)]
            if able and self._others_first(floor, job):
                sent = True
            elif able and _can_be_taken(floor, job):
                self.waiting.remove(claim)
                worker = min(able, key=partial(_key, floor, station, job))
                self.coming[worker.rank], floor.called[worker.rank] = job, self
                send(floor, worker, station, job)
                sent = True
        return sent

    def _others_first(self, floor: Floor, job: Job) -> bool:
        """Whether whoever works here all the time is free for the job, and may be sent in this instant."""
        calls = any(claim[3] is job for claim in job.station.calling)
        if self.left_s == floor.now or not calls or not any(w.may_serve(job.station) for w in floor.free.values()):
            return False
        self.left_s = floor.now
        return True

    def act(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody who was called is there, or at the beginning of the stretch: he does what he was called for."""
        if self.coming.get(worker.rank) is not job:
            return False
        if self.line.walks_to(floor, job, worker):
            return True
        del self.coming[worker.rank], floor.called[worker.rank]
        worker.since_s = floor.now
        if not (_may(worker, job.station) and _can_be_taken(floor, job)):
            set_free(floor, worker)
            self.call(floor, job)
        elif self.helping is not None and can_help(floor, job):
            self.helping.begin(floor, job, worker)
            self.call(floor, job)  # for the tasks that follow
        else:
            self._take(floor, job, worker)
        return True

    def turns_back(self, floor: Floor, worker: Worker, job: Job) -> None:
        """Somebody on his way has to go: the job calls for others, where nobody is at it or comes."""
        del self.coming[worker.rank], floor.called[worker.rank]
        worker.job = None
        self.call(floor, job)
        waits = (
            job.kind == HELD and job.cause == NO_WORKER and all(claim[3] is not job for claim in job.station.calling)
        )
        if waits and not any(other.job is job for other in floor.workers):
            call_again(floor, job)

    def _take(self, floor: Floor, job: Job, worker: Worker) -> None:
        if job.kind == HELD:
            self.line.stop_walks(floor, job, but=worker.rank)
            turn_away(floor, job, but=worker.rank)
            for told in floor.lost_server if job.cause == AWAY else ():
                told(floor, job, job.station)
        take_over(floor, job, worker)


def _may(worker: Worker, station: Station) -> bool:
    """Whether somebody who is called may go to a station: he has the skill, and no other block keeps him."""
    masks = [mask for block, mask in worker.limits.items() if block != LINES]
    return worker.rating[station.rank] > 0 and all(mask >> station.rank & 1 for mask in masks)


def _can_be_taken(floor: Floor, job: Job) -> bool:
    """Whether one worker alone is at the job and is not being helped, or nobody is and somebody is wanted."""
    if job.team is not None:
        return False
    if job.kind in (WORK, SETUP):  # else who is at it is done in this very instant
        return job.worker >= 0 and job.since_s + job.duration_s > floor.now
    if job.station.down or job.kind != HELD or job.cause not in (NO_WORKER, AWAY):
        return False
    task = job.station.tasks[job.task_position] if job.setup_task < 0 else job.setup_task
    return floor.plan.tasks[task].team == 1


def _key(floor: Floor, station: Station, job: Job, worker: Worker) -> tuple[float, ...]:
    return pair_key(floor, worker, station, job, 1, job.since_s)
