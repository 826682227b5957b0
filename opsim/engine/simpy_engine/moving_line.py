"""Moving lines: jobs ride on a line that moves all the time, past stations that are stretches of it."""

from __future__ import annotations

from functools import partial

from opsim.engine.simpy_engine.andon import Andon
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.line_walks import LineWalks
from opsim.engine.simpy_engine.material import leave_server, move_on
from opsim.engine.simpy_engine.paced_line import AT_THE_END, PacedLine
from opsim.engine.simpy_engine.sent_on import send_on
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.station import seat
from opsim.log import FULL, LINE_STOP, NO_CAUSE, QUEUE, TAKT, UNFINISHED
from opsim.plan import LinePlan


class MovingLine(PacedLine):
    """began_s : by job number, what the clock showed when it came onto the line

    open_at : by job number, at the how many-th station something is left to be done of it
    late    : jobs at the limit of a station that are waited for; ending : those at the end that cannot leave
    """

    def __init__(self, floor: Floor, plan: LinePlan):
        super().__init__(floor, plan)
        self.floor = floor
        self.began_s: dict[int, float] = {}
        self.open_at: dict[int, int] = {}
        self.late: set[int] = set()
        self.ending: set[int] = set()
        self.at = {rank: at for at, rank in enumerate(plan.stations)}
        self.walks = LineWalks(floor, self)
        self.andon = Andon(floor, self) if plan.floaters else None
        for station in self.stations:
            station.receive, station.vacate = self._receive, _vacate
            station.add_after(AT_THE_END, self._done_here)
        self.stations[-1].clear = _clear
        floor.left_station.append(self._left_station)
        floor.left_floor.append(self._left_floor)

    def is_open(self, job: Job) -> bool:
        return self.open_at.get(job.number, -1) == self.at.get(job.station.rank, -2)

    def job_m(self, began_s: float, now: float) -> float:
        """Where a job is that came onto the line when the clock showed ``began_s``."""
        return (self.clock.now_s(now) - began_s) * self.plan.speed_m_per_s

    def move(self, floor: Floor) -> tuple[int, bool]:
        self.opens(floor)
        return NO_CAUSE, True

    def kept(self, floor: Floor) -> int:
        if self.ending:
            return FULL
        return super().kept(floor) or (UNFINISHED if self.late else NO_CAUSE)

    def stood(self, floor: Floor) -> None:
        self.walks.line_changed(floor)

    def walks_to(self, floor: Floor, job: Job, worker: Worker) -> bool:
        return self.walks.act(floor, job, worker)

    def stop_walks(self, floor: Floor, job: Job, but: int = -1) -> None:
        self.walks.stop(floor, job, but)

    def _receive(self, floor: Floor, station: Station, job: Job) -> None:
        """The job is done at the station before, or comes onto the line: it rides until its worker may begin."""
        at, now_s = self.at[station.rank], self.clock.now_s(floor.now)
        began_s = self.began_s.setdefault(job.number, now_s)
        self.open_at[job.number] = at
        plan, clock = self.plan, self.clock
        clock.at(floor, began_s + plan.limit_s[at], station.rank, job.number, partial(self._limit, job, at))
        if self.andon is not None:
            call_s = max(began_s + plan.start_s(at) + plan.call_s, now_s)
            if call_s > now_s:
                clock.at(floor, call_s, station.rank, job.number, partial(self._call, self.andon, job, at))
            else:
                self.andon.call(floor, job)
        reach_s = began_s + plan.reach_s[at]
        if reach_s > now_s:
            floor.job_now(job, QUEUE, TAKT)
            clock.at(floor, reach_s, station.rank, job.number, partial(_in_reach, job))
        else:
            _in_reach(job, floor)

    def _limit(self, job: Job, at: int, floor: Floor) -> None:
        """The job is where its worker must stop."""
        if self.open_at.get(job.number) != at:
            return
        if self.plan.sends_on:
            self.stop_walks(floor, job)
            if send_on(floor, job):
                return
        self.late.add(job.number)

    def _call(self, andon: Andon, job: Job, at: int, floor: Floor) -> None:
        if self.open_at.get(job.number) == at:
            andon.call(floor, job)

    def _done_here(self, floor: Floor, job: Job) -> bool:
        """On to the next station; from the last one the job rides to the end of the line, off its server."""
        del self.open_at[job.number]
        self.late.discard(job.number)
        self._nobody_comes(floor, job)
        station = job.station
        if station is not self.stations[-1]:
            return True
        exit_s = self.began_s[job.number] + self.plan.exit_s
        if exit_s <= self.clock.now_s(floor.now):
            self.ending.add(job.number)
            return True
        floor.job_now(job, QUEUE, TAKT)
        if job in (station.seated or ()):
            leave_server(floor, station, job)
        self.clock.at(floor, exit_s, station.rank, job.number, partial(self._at_the_end, job))
        return False

    def _at_the_end(self, job: Job, floor: Floor) -> None:
        self.ending.add(job.number)
        move_on(floor, job)

    def _left_station(self, floor: Floor, job: Job, station: Station) -> None:
        if station.rank in self.at:
            self._nobody_comes(floor, job)
        if station is self.stations[-1]:
            self._forget(job)

    def _nobody_comes(self, floor: Floor, job: Job) -> None:
        self.walks.stop(floor, job)
        if self.andon is not None:
            self.andon.done(floor, job)

    def _left_floor(self, _floor: Floor, job: Job) -> None:
        if job.number in self.began_s:
            self._forget(job)

    def _forget(self, job: Job) -> None:
        """The job is on the line no more."""
        self.began_s.pop(job.number, None)
        self.open_at.pop(job.number, None)
        self.late.discard(job.number)
        self.ending.discard(job.number)


def _in_reach(job: Job, floor: Floor) -> None:
    """The job is where its worker may begin: on a server where one is free."""
    station = job.station
    floor.job_now(job, QUEUE)
    if station.free_servers:
        seat(floor, station, job)
    else:
        station.queue.append(job)


def _vacate(floor: Floor, station: Station, job: Job) -> None:
    """A job goes on, and gives its server back where it has one still."""
    if job in (station.seated or ()):
        leave_server(floor, station, job)


def _clear(floor: Floor, station: Station, job: Job) -> None:
    """A job at the end of the line that cannot leave it is off its server."""
    floor.job_now(job, QUEUE, LINE_STOP)
    if job in (station.seated or ()):
        leave_server(floor, station, job)
