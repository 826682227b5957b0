"""A station that stops at times: one stop at a time, and what falls due meanwhile follows."""

from __future__ import annotations

from dataclasses import dataclass, field

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.interruption import forget_progress, start_station, stop_station
from opsim.engine.simpy_engine.material import leave_floor, leave_station, withdraw
from opsim.engine.simpy_engine.state import Job, Station
from opsim.engine.simpy_engine.station import proceed, quiet
from opsim.engine.simpy_engine.stops import Stop
from opsim.engine.simpy_engine.wear import Wear
from opsim.log import BREAKDOWN, HELD, IS_DOWN, SCRAP, SETUP, WORK


@dataclass(slots=True, eq=False)
class Failing:
    """closed : whether it is out of its hours

    now : because of which it stands; due : stops that are to come; held : jobs on servers that wait for them

    pending : all stations with stops that are due, by rank; shared by all
    """

    station: Station
    pending: dict[int, Failing]
    wear: Wear = field(default_factory=Wear)
    now: Stop | None = None
    due: list[Stop] = field(default_factory=list)
    held: list[Job] = field(default_factory=list)
    closed: bool = False

    def switch(self, floor: Floor, closed: bool) -> None:
        """The station closes, or opens: while it is closed the clock of what wears it out stands still."""
        self.closed = closed
        if closed:
            self.wear.stand_still(floor)
        elif self.now is None:
            self.wear.go_on(floor)

    def fall_due(self, stop: Stop) -> None:
        """The stop begins as soon as it may; who waits already is not doubled."""
        if stop not in self.due:
            self.due.append(stop)
            self.pending[self.station.rank] = self

    def may_begin(self, floor: Floor, job: Job) -> bool:
        """The last preparation of a job: no operation begins where a stop is due, or cycles are used up."""
        for cycles in self.wear.cycles:
            if cycles.left <= 0:
                self.fall_due(cycles.stop)
        if self.now is None and not self.due:
            return True
        self._hold(floor, job)
        return False

    def strike(self, floor: Floor) -> bool:
        """The station stops where a stop is due and may begin; True where it did."""
        if self.now is not None:
            return False
        stop = self._next()
        if stop is None:
            self._call_off(floor)
            return False
        in_work = [job for job in self.station.seated or () if job.kind == WORK]
        stop_station(floor, self.station)
        self.wear.stand_still(floor)
        self._take(floor, stop)
        for job in in_work:
            if stop.job == "restart":
                forget_progress(job)
            elif stop.job == "scrap":
                _scrap(floor, self.station, job)
        return True

    def repaired(self, floor: Floor) -> None:
        """The stop is over: the next one that is due follows, or the station goes on."""
        assert self.now is not None
        self.now.end(floor)
        self.now = None
        stop = self._next()
        if stop is not None:
            self._take(floor, stop)
            return
        if not self.closed:
            self.wear.go_on(floor)
        start_station(floor, self.station)
        held, self.held = self.held, []
        for job in sorted(held, key=lambda job: job.number):
            if job in (self.station.seated or ()):
                proceed(floor, job)

    def _next(self) -> Stop | None:
        """The first stop that is due and may begin: what waits for jobs to be done lets others pass."""
        waits = any(_is_begun(job) for job in self.station.seated or () if job not in self.held)
        return next((stop for stop in self.due if not (waits and stop.after_job)), None)

    def _take(self, floor: Floor, stop: Stop) -> None:
        self.due.remove(stop)
        if not self.due:
            del self.pending[self.station.rank]
        self.now = stop
        self.wear.renew(stop)
        stop.begin(floor)

    def _call_off(self, floor: Floor) -> None:
        """No worker, team or tool is waited for by a job that was not begun."""
        station = self.station
        for claim in list(station.calling):
            job = claim[3]
            if job.setup_task < 0 and not _is_begun(job):
                station.calling.remove(claim)
                job.stage = station.stages.index(self.may_begin)
                self._hold(floor, job)
        quiet(floor, station)
        for job in list(station.seated or ()) if floor.call_off else ():
            ready = job.stage == len(station.stages) and job.setup_task < 0 and not _is_begun(job)
            waited = [ask(floor, job) for ask in floor.call_off] if ready else []
            if any(waited):
                job.stage = station.stages.index(self.may_begin)
                self._hold(floor, job)

    def _hold(self, floor: Floor, job: Job) -> None:
        floor.job_now(job, HELD, IS_DOWN)
        self.held.append(job)


def _is_begun(job: Job) -> bool:
    """Whether something was done of the operation of a job on its server, and something is left."""
    if job.kind == WORK or job.kind == SETUP:
        return True
    n_tasks = len(job.station.tasks)
    return job.kind == HELD and (job.rest_s > 0 or job.repeats_done > 0 or 0 < job.task_position < n_tasks)


def _scrap(floor: Floor, station: Station, job: Job) -> None:
    """What was in work is lost, with all that was on the same server."""
    together = [one for one in station.seated or () if one is job or (job.seat is not None and one.seat is job.seat)]
    station.standing.remove(job)
    for one in together:
        if one.ahead is not None:
            withdraw(floor, one)
        leave_station(floor, one)
        leave_floor(floor, one, SCRAP, BREAKDOWN, station.rank)
