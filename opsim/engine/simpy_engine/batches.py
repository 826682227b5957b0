"""Batches: several jobs take one server together, and its tasks are done once for all of them."""

from math import inf

from opsim.engine.rules import CALENDAR
from opsim.engine.rules.batch import batch_begins
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.material import ask_after
from opsim.engine.simpy_engine.state import Job, Seat, Station
from opsim.engine.simpy_engine.station import seat
from opsim.log import BATCH, HELD, QUEUE
from opsim.plan.assembly import BatchPlan

WAITED_ENOUGH = "a job has waited long enough for a batch"
ORDER = 0
"""Among what is asked when an operation is done."""


class Oven:
    """since_s : by job number, since when each job waits; overdue : whether one of them may have waited long enough."""

    def __init__(self, plan: BatchPlan, station: Station):
        self.plan, self.station = plan, station
        self.since_s: dict[int, float] = {}
        self.overdue = False

    def serve(self, floor: Floor, station: Station) -> None:
        """Begin batches as long as there are servers and jobs for them, and the station is up; the others wait on."""
        self._welcome(floor)
        while station.free_servers and not station.down and (together := self._next(floor)):
            self._begin(floor, together)
        cause = BATCH if station.free_servers else 0
        for job in station.queue:
            if job.cause != cause and job.kind == QUEUE:
                floor.job_now(job, QUEUE, cause)

    def serve_overdue(self, floor: Floor) -> bool:
        """Begin what has waited long enough, once all that came at this instant is there; True: something began."""
        if not self.overdue:
            return False
        self.overdue = False
        free = self.station.free_servers
        self.serve(floor, self.station)
        return self.station.free_servers < free

    def _welcome(self, floor: Floor) -> None:
        """Take note of who has come since."""
        for job in self.station.queue:
            if job.number not in self.since_s:
                self.since_s[job.number] = floor.now
                if self.plan.most_wait_s < inf:
                    floor.alarm(self.plan.most_wait_s, CALENDAR, self.station.rank, job.number, WAITED_ENOUGH, self)

    def _next(self, floor: Floor) -> list[Job]:
        """The jobs of the next batch in the order of the queue, of the first class that may begin."""
        station, plan = self.station, self.plan
        in_line = list(station.queue) if station.order is None else sorted(station.queue, key=station.order)
        by_class: dict[int, list[Job]] = {}
        for job in in_line:
            by_class.setdefault(plan.class_of[job.product], []).append(job)
        for jobs in by_class.values():
            longest_s = floor.now - min(self.since_s[job.number] for job in jobs)
            if batch_begins(len(jobs), plan.size, longest_s, plan.most_wait_s):
                return jobs[: plan.size]
        return []

    def _begin(self, floor: Floor, together: list[Job]) -> None:
        """The first of them stands for all: it is worked on, the others are with it."""
        station, leader = self.station, together[0]
        shared = Seat(len(together))
        for job in together:
            station.queue.remove(job)
            del self.since_s[job.number]
            job.seat = shared
        leader.members = tuple(together[1:])
        for job in leader.members:
            floor.job_now(job, HELD, BATCH)
            job.task_position = job.repeats_done = 0
            if station.seated is not None:
                station.seated.append(job)
        station.capacity += len(together)
        floor.stir(station)
        seat(floor, station, leader)

    def done(self, floor: Floor, job: Job) -> bool:
        """What holds for the first of a batch when its operation is done holds for each of them."""
        members, job.members = job.members, ()
        for one in members:
            ask_after(floor, one)
        return True


def install(floor: Floor) -> None:
    """Stations that serve batches: their jobs wait in the buffer, and have no room on servers before they begin."""
    for plan in floor.plan.batches:
        station = floor.stations[plan.station]
        oven = Oven(plan, station)
        station.capacity -= station.plan.servers
        station.per_lot = (True,) * len(station.tasks)
        station.serve = oven.serve
        station.add_after(ORDER, oven.done)
        if plan.most_wait_s < inf:
            floor.dispatchers.append(oven.serve_overdue)


def _waited_enough(_floor: Floor, oven: Oven) -> None:
    oven.overdue = True


HANDLERS: dict[str, Handler] = {WAITED_ENOUGH: _waited_enough}
