"""Two at one task: who helps takes his own share of what is left, and both are done at once."""

from __future__ import annotations

from collections.abc import Iterable

from opsim.clock import on_grid
from opsim.engine.rules.lines import together_s
from opsim.engine.simpy_engine.floor import Floor, progress
from opsim.engine.simpy_engine.interruption import release_team
from opsim.engine.simpy_engine.state import Act, Job, Station, Worker
from opsim.engine.simpy_engine.station import drawn_s
from opsim.engine.simpy_engine.stints import Stint
from opsim.engine.simpy_engine.worker import stop
from opsim.log import WORK


class Helping:
    """slower : by the number of a job that is helped with, how much longer the rest would take one alone."""

    def __init__(self, floor: Floor):
        self.slower: dict[int, float] = {}
        floor.broken_off.append(self._broken_off)

    def hang(self, station: Station) -> None:
        """Who helps at a station is free when the task is done."""
        station.acted = self._and_then(station.acted)

    def begin(self, floor: Floor, job: Job, worker: Worker) -> None:
        """From now on two are at the task, whose rest goes by the sum of their paces."""
        station, now = job.station, floor.now
        done, alone_s = progress(job, now), job.since_s + job.duration_s - now
        his_s, k = drawn_s(floor, station, worker, job.task)
        rest_s = on_grid(together_s(alone_s, his_s * (1.0 - done)))
        self.slower[job.number] = alone_s / rest_s
        _go_on_at_another_pace(floor, job, done, rest_s)
        number = _another(floor)
        worker.stint = Stint(
            station.rank, job.product, job.operation_rank, job.task, number, k, rest_s, done, worker.pace_shift
        )
        if floor.humans:
            floor.humans[worker.rank].works(now, job.task, now + rest_s, done, k)
        worker.job, worker.station = job, station
        worker.kind, worker.since_s = WORK, now
        job.team = [worker]

    def end(self, floor: Floor, job: Job) -> None:
        """Who helps has to go, and the other one goes on alone."""
        rest_s = (job.since_s + job.duration_s - floor.now) * self.slower.pop(job.number)
        _go_on_at_another_pace(floor, job, progress(job, floor.now), on_grid(rest_s))
        release_team(floor, job)

    def _broken_off(self, floor: Floor, job: Job) -> None:
        """Who goes on alone needs longer for the rest."""
        slower = self.slower.pop(job.number, None)
        if slower is not None and job.rest_s:
            job.rest_s = on_grid(job.rest_s * slower)
            job.performance_id = _another(floor)

    def _and_then(self, acted: Act | None) -> Act:
        def over(floor: Floor, job: Job, worker: Worker) -> bool:
            if self.slower.pop(job.number, None) is not None:
                release_team(floor, job)
            return acted is not None and acted(floor, job, worker)

        return over


def helping_at(floor: Floor, stations: Iterable[Station]) -> Helping:
    """The help of a floor, which can be had at some stations too."""
    if floor.helping is None:
        floor.helping = Helping(floor)
    for station in stations:
        floor.helping.hang(station)
    return floor.helping


def _go_on_at_another_pace(floor: Floor, job: Job, done: float, rest_s: float) -> None:
    """Who works at the job goes on, and needs another time for the rest: a piece of its own begins."""
    worker = floor.workers[job.worker]
    floor.log_job(job)
    job.since_s, job.progress_from, job.rest_s, job.duration_s = floor.now, done, rest_s, rest_s
    job.performance_id = _another(floor)
    stop(floor, worker)
    worker.since_s = floor.now
    if floor.humans:
        floor.humans[worker.rank].works(floor.now, job.task, floor.now + rest_s, done, job.k)
    floor.at_end_of(rest_s, worker.stretch_over)


def _another(floor: Floor) -> int:
    """The number of a performance, or of a part of one that goes at a pace of its own."""
    number, floor.n_performances = floor.n_performances, floor.n_performances + 1
    return number


def can_help(floor: Floor, job: Job) -> bool:
    """Whether somebody works at a task that two can share: one without a tool in the hands or a time of the station."""
    if job.kind != WORK or job.worker < 0:
        return False
    task = floor.plan.tasks[job.task]
    return task.hold is None and not task.attended
