"""cimba: coroutines in C, models written in Python and compiled by numba.

It draws for itself and cannot be given numbers: its answers are held against the long run, within standard errors.
NOTE: this module is to be imported before any other function of numba is compiled, else cimba 0.9.5 fails.
"""

import cimba
import numpy as np
from bench.peers.times import ARRIVALS_PER_S, BUFFER, N_STATIONS, POOL_ARRIVALS_PER_S, POOL_STATIONS, SKILLS
from cimba import inputs


class Queue(cimba.Model):
    """M/M/1."""

    gap: cimba.Input[float] = inputs.dist.exponential(mean=1 / ARRIVALS_PER_S)
    service: cimba.Input[float] = inputs.dist.exponential(mean=1.0)
    came: cimba.Store[float]
    spent_s: float = 0.0
    finished: int = 0
    total_s: cimba.Output[float]
    jobs: cimba.Output[float]

    @cimba.process
    def arrivals(self):
        while True:
            cimba.hold(self.gap.next())
            self.came.put(cimba.now())

    @cimba.process
    def server(self):
        while True:
            came_s = self.came.get()
            cimba.hold(self.service.next())
            self.spent_s += cimba.now() - came_s
            self.finished += 1

    @cimba.on_end
    def close(self):
        self.total_s = self.spent_s
        self.jobs = float(self.finished)


class Station(cimba.Model):
    """One machine of the line with the buffer behind it."""

    service: cimba.Input[float] = inputs.dist.exponential(mean=1.0)
    is_first: cimba.Param[int] = 0
    is_last: cimba.Param[int] = 0
    after: cimba.Store[int]
    before: cimba.Ref["Station"]
    finished: int = 0
    jobs: cimba.Output[float]

    def __init__(self, capacity):
        self.after = cimba.Store(capacity=capacity)

    @cimba.process
    def serve(self):
        while True:
            part = 1
            if self.is_first == 0:
                part = self.before.after.get()
            cimba.hold(self.service.next())
            if self.is_last == 0:
                self.after.put(part)
            else:
                self.finished += 1

    @cimba.on_end
    def close(self):
        self.jobs = float(self.finished)


class Line(cimba.Model):
    stations: list[Station]


class Worker(cimba.Model):
    unit: cimba.Resource = cimba.Resource(capacity=1)


class Spent(cimba.Model):
    """Of all jobs that were finished."""

    spent_s: float = 0.0
    finished: int = 0
    total_s: cimba.Output[float]
    jobs: cimba.Output[float]

    @cimba.on_end
    def close(self):
        self.total_s = self.spent_s
        self.jobs = float(self.finished)


class Area(cimba.Model):
    """A station, and where its jobs come from."""

    gap: cimba.Input[float] = inputs.dist.exponential(mean=POOL_STATIONS / POOL_ARRIVALS_PER_S)
    service: cimba.Input[float] = inputs.dist.exponential(mean=1.0)
    skilled: list[cimba.Ref[cimba.Resource]]
    spent: cimba.Ref[Spent]

    @cimba.process
    def arrivals(self):
        while True:
            cimba.hold(self.gap.next())
            cimba.spawn(Job, at=self)


class Job(cimba.Model):
    at: cimba.Ref[Area]

    @cimba.process
    def run(self):
        came_s = cimba.now()
        worker = cimba.acquire_any(self.at.skilled)
        cimba.hold(self.at.service.next())
        self.at.skilled[worker].release()
        self.at.spent.spent_s += cimba.now() - came_s
        self.at.spent.finished += 1
        cimba.release(self)


class Pool(cimba.Model):
    workers: list[Worker]
    areas: list[Area]
    spent: Spent


def mm1(until_s, seed):
    queue = Queue()
    return _mean(_run(queue, until_s, seed)[queue])


def line(until_s, seed):
    stations = [Station(BUFFER) for _ in range(N_STATIONS)]
    for rank, station in enumerate(stations):
        station.is_first, station.is_last = int(rank == 0), int(rank == N_STATIONS - 1)
        station.before = stations[max(rank - 1, 0)]
    whole = Line()
    whole.stations = stations
    finished = _number(_run(whole, until_s, seed)[stations[-1]].jobs)
    return int(finished), finished / until_s


def pool(until_s, seed):
    workers, spent, areas = [Worker() for _ in SKILLS], Spent(), []
    for rank in range(POOL_STATIONS):
        area = Area()
        area.skilled = [workers[w].unit for w, able in enumerate(SKILLS) if rank in able]
        area.spent = spent
        areas.append(area)
    whole = Pool()
    whole.workers, whole.areas, whole.spent = workers, areas, spent
    return _mean(_run(whole, until_s, seed)[spent])


def _run(model, until_s, seed):
    return cimba.Experiment(model, replications=1, seed=seed, window=cimba.Window(duration=until_s)).run(workers=1)


def _mean(found) -> tuple[int, float]:
    finished = _number(found.jobs)
    return int(finished), _number(found.total_s) / finished


def _number(column) -> float:
    return float(np.asarray(column).ravel()[0])
