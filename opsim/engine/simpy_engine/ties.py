"""Jobs that wait for one worker: for him who began the task, or who has to carry them."""

from bisect import insort

from opsim.engine.simpy_engine.allocation import send
from opsim.engine.simpy_engine.floor import Floor, pair_key
from opsim.engine.simpy_engine.interruption import call_again
from opsim.engine.simpy_engine.state import CREWS, Claim, Job, Station, Worker, claim_of
from opsim.engine.simpy_engine.worker import hold, set_free
from opsim.log import HELD


class Ties:
    """job_of : by the rank of a worker who is away, the job that waits for him, or that he goes to carry; none has two

    left : jobs that somebody would have to carry who has gone off: anybody does
    """

    def __init__(self, floor: Floor):
        self.job_of: dict[int, Job] = {}
        self.left: list[Claim] = []
        floor.left_station.append(self.untie)
        floor.lost_server.append(self.untie)

    def tie(self, worker: Worker, job: Job) -> None:
        """The job, which he has left on its server, waits for him."""
        self.job_of[worker.rank] = job

    def put_down(self, floor: Floor, worker: Worker, job: Job) -> None:
        """He leaves the blocked job he stands by; what he has to carry goes nowhere before he is back."""
        job.held_by = None
        set_free(floor, worker)
        if job.plan.carried and not _is_fetched(floor, job):
            job.gate.claims = [claim for claim in job.gate.claims if claim[3] is not job]
            if CREWS not in worker.limits:  # else whoever of his crew comes to it carries it on
                self.job_of[worker.rank] = job

    def untie(self, _floor: Floor, job: Job, _station: Station) -> None:
        """The job is gone, or has lost its server: it waits for nobody."""
        for rank in [rank for rank, tied in self.job_of.items() if tied is job]:
            del self.job_of[rank]
        self.left = [claim for claim in self.left if claim[3] is not job]

    def goes_off(self, floor: Floor, worker: Worker) -> None:
        """His shift is over: what he has to carry is for anybody; what he began waits on for him."""
        job = self.job_of.get(worker.rank)
        if job is not None and job.kind != HELD:
            del self.job_of[worker.rank]
            insort(self.left, claim_of(job, floor.now))

    def release(self, floor: Floor, worker: Worker) -> None:
        """He does not come: what he began is for anybody."""
        job = self.job_of.get(worker.rank)
        if job is not None and job.kind == HELD:
            del self.job_of[worker.rank]
            call_again(floor, job)

    def send(self, floor: Floor) -> bool:
        """Where there is room for a job that nobody carries, send who is free and may serve its station, by the rule of
        allocation. True where somebody goes.
        """
        sent = False
        for claim in list(self.left):
            job = claim[3]
            carrier = _best(floor, job, claim[1]) if job.gate.may_enter(job) else None
            if carrier is not None:
                self.left.remove(claim)
                self.job_of[carrier.rank] = job
                send(floor, carrier, job.station, job)
                sent = True
        return sent

    def go_back(self, floor: Floor, worker: Worker) -> bool:
        """Send somebody who is free, and back, to the job that waits for him; True where there was one.

        Where its station stands still, or its tools are gone, the job has to wait, and is for anybody then.
        """
        job = self.job_of.get(worker.rank)
        if job is None:
            return False
        if job.kind != HELD or _may_go_on(floor, job):
            send(floor, worker, job.station, job)
            return True
        del self.job_of[worker.rank]
        if job.station.down:
            call_again(floor, job)
        return True

    def met(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """He has come to a job; True where he has nothing to do there but to wait until he can carry it."""
        if self.job_of.get(worker.rank) is not job:
            return False
        del self.job_of[worker.rank]
        if job.kind == HELD:
            return False
        worker.since_s = floor.now  # what he did until now is written
        hold(floor, worker, job)
        insort(job.gate.claims, claim_of(job, floor.now))
        floor.stirred.add(job.gate)
        return True


def _best(floor: Floor, job: Job, since_s: float) -> Worker | None:
    """Who carries a job that was left; on patrol, only who stands at its station."""
    station = job.station
    able = [worker for worker in floor.free.values() if worker.may_serve(station)]
    if floor.plan.idle == "patrol":
        able = [one for one in able if one.place == station.place and station.rank in one.plan.patrol]
    n_waiting = 1 + len(station.queue)
    return min(able, key=lambda one: pair_key(floor, one, station, job, n_waiting, since_s), default=None)


def _may_go_on(floor: Floor, job: Job) -> bool:
    """Whether its station is up, and the tools are there that go with the worker."""
    station = job.station
    if station.down:
        return False
    return job.setup_task >= 0 or station.ready is None or station.ready(floor, job)


def _is_fetched(floor: Floor, job: Job) -> bool:
    """Whether a vehicle comes for it."""
    ways = [(job.station.rank, station.rank) for station in job.gate.stations]
    return bool(floor.legs) and all(way in floor.legs for way in ways)
