"""Indexed lines: all jobs move by one station at the same instant."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from opsim.engine.simpy_engine.andon import Andon
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.material import move_on
from opsim.engine.simpy_engine.paced_line import AT_THE_END, TICK, PacedLine, shut_but_at
from opsim.engine.simpy_engine.sent_on import send_on
from opsim.engine.simpy_engine.state import Job, Station
from opsim.log import FULL, HELD, LINE_STOP, NO_CAUSE, TAKT, UNFINISHED
from opsim.plan import LinePlan


class IndexedLine(PacedLine):
    """done : numbers of the jobs that wait for the move; leaving : whether the last station's is on its way out."""

    def __init__(self, floor: Floor, plan: LinePlan):
        super().__init__(floor, plan)
        self.done: set[int] = set()
        self.leaving = False
        self.andon = Andon(floor, self) if plan.floaters else None
        for station in self.stations:
            station.add_after(AT_THE_END, self._done_here)
        floor.left_station.append(self._left_station)
        for station in self.stations[1:]:
            shut_but_at(floor, self, station)

    def is_open(self, job: Job) -> bool:
        return job.number not in self.done and job in (job.station.seated or ())

    def move(self, floor: Floor) -> tuple[int, bool]:
        """All jobs move on by one station, the last one first, where they are done and it can leave."""
        late, changed = [job for job in self._jobs() if self._is_late(job)], False
        if self.plan.sends_on:
            changed = sum(send_on(floor, job) for job in late) > 0
            late = [job for job in self._jobs() if self._is_late(job)]
        if late:
            return UNFINISHED, changed
        last = _job_at(self.stations[-1])
        if last is not None and not self.leaving:
            self.leaving = changed = True
            self.done.discard(last.number)
            move_on(floor, last)
        if _job_at(self.stations[-1]) is not None:
            return FULL, changed
        self._index(floor)
        return NO_CAUSE, True

    def stood(self, floor: Floor) -> None:
        """Jobs that wait for the move wait for the line to run."""
        for job in self._jobs():
            if job.number in self.done:
                floor.job_now(job, HELD, self._waits_for)

    @property
    def _waits_for(self) -> int:
        return TAKT if self.why == NO_CAUSE else LINE_STOP

    def _is_late(self, job: Job) -> bool:
        return job.number not in self.done and not (self.leaving and job.station is self.stations[-1])

    def _index(self, floor: Floor) -> None:
        self.leaving = False
        self.done.clear()
        self.opens(floor)
        for station in self.stations[-2::-1]:
            job = _job_at(station)
            if job is not None:
                move_on(floor, job)
        if self.andon is not None:
            call_s = self.clock.now_s(floor.now) + self.plan.call_s
            self.clock.at(floor, call_s, self.stations[0].rank, TICK, partial(self._call, self.andon))

    def _call(self, andon: Andon, floor: Floor) -> None:
        for job in self._jobs():
            if job.number not in self.done:
                andon.call(floor, job)

    def _done_here(self, floor: Floor, job: Job) -> bool:
        """The job stays on its server until the line moves."""
        self.done.add(job.number)
        floor.job_now(job, HELD, self._waits_for)
        if self.andon is not None:
            self.andon.done(floor, job)
        return False

    def _left_station(self, floor: Floor, job: Job, station: Station) -> None:
        """A job that was scrapped is waited for by nobody."""
        if self.andon is not None and station in self.stations:
            self.andon.done(floor, job)

    def _jobs(self) -> Iterator[Job]:
        """The jobs on the line, from its beginning."""
        return (job for station in self.stations for job in station.seated or ())


def _job_at(station: Station) -> Job | None:
    return station.seated[0] if station.seated else None
