"""What the twins share: times of named random streams on the grid, and a row for each state that somebody was in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import count
from math import inf
from typing import Any, NamedTuple

import numpy as np
import simpy

from opsim.streams import BLOCK, stream

TICKS_PER_S = 2**20
Draw = Callable[[np.random.Generator, bool], np.ndarray]
"""A block of times, in whole seconds (and then geometric, of the same mean) or not."""


class Row(NamedTuple):
    """What the twins say of a row of the event log: names as text, "" for none; -1 where the log has no number.

    Left out are source, operation, number of the performance and shift of pace: the other columns tell them here.
    """

    end_s: float
    start_s: float
    kind: str
    worker: str = ""
    station: str = ""
    place_from: str = ""
    place_to: str = ""
    job: int = -1
    product: str = ""
    task: str = ""
    k: int = -1
    progress_from: float = -1.0
    progress_to: float = -1.0
    cause: str = ""


def exponential(mean_s: float) -> Draw:
    return lambda rng, whole: geometric(rng, mean_s) if whole else rng.exponential(mean_s, BLOCK)


def uniform(low_s: float, high_s: float) -> Draw:
    return lambda rng, whole: geometric(rng, (low_s + high_s) / 2) if whole else rng.uniform(low_s, high_s, BLOCK)


def geometric(rng: np.random.Generator, mean_s: float) -> np.ndarray:
    return 1.0 * rng.geometric(1.0 / mean_s, BLOCK)


def on_grid(delay_s: float) -> float:
    """A delay rounded to a multiple of 2^-20 s, at least one of them."""
    return max(1, round(delay_s * TICKS_PER_S)) / TICKS_PER_S


class EndOfInstant(simpy.Event):
    """Comes after all other events of this instant, whose priorities are 0 and 1 in SimPy; the smaller order first.

    So jobs that come at one instant are let in by number, and who is free is sent when all have come.
    """

    def __init__(self, env: simpy.Environment, order: float = inf):
        super().__init__(env)
        self._ok, self._value = True, None
        env.schedule(self, priority=2 + order)


class Floor:
    """An environment, the random streams of a replication, and rows.

    whole    : whether all times are whole seconds, so that much happens at one instant
    subjects : all who are in some state
    """

    def __init__(self, seed: int, replication: int, whole: bool = False):
        self.env = simpy.Environment()
        self.seed, self.replication, self.whole = seed, replication, whole
        self.rows: list[Row] = []
        self.subjects: list[Subject] = []

    def times(self, draw: Draw, *name: str, rating: float = 1.0) -> Iterator[tuple[int, float]]:
        """(k, seconds) of a stream for k = 0, 1, 2, ..., each rounded to the grid."""
        blocks = (draw(stream(self.seed, self.replication, *name, block), self.whole) for block in count())
        return enumerate(on_grid(time_s / rating) for times_s in blocks for time_s in times_s.tolist())

    def chance(self, item: int, *name: str | int) -> float:
        """The number in [0, 1) of an item of a stream."""
        block, row = divmod(item, BLOCK)
        return stream(self.seed, self.replication, *name, block).random(BLOCK)[row]

    def poisson(self, mean_s: float, job: Callable[..., Any], source: str = "release", **about: Any) -> None:
        """``job(n)`` is a process for each n = 0, 1, 2, ..., begun after gaps of the source's stream."""

        def arrivals():
            for n, gap_s in self.times(exponential(mean_s), "interarrival", source):
                yield self.env.timeout(gap_s)
                self.env.process(job(n, **about))

        self.env.process(arrivals())

    def run(self, until_s: float) -> list[Row]:
        """All rows; states that last until the end are closed there."""
        self.env.run(until=until_s)
        for subject in self.subjects:
            subject.close(until_s)
        return self.rows


class Subject:
    """A job, a worker, a machine or a vehicle, in one state at a time; its row is written when the next one begins.

    who : what all of its rows say
    """

    def __init__(self, floor: Floor, **who: Any):
        self.floor, self.env, self.who = floor, floor.env, who
        self.state: dict[str, Any] | None = None
        self.since_s = 0.0
        floor.subjects.append(self)

    def now(self, kind: str, lasts_s: float = 0.0, **about: Any) -> None:
        """Its state is another one from now on; of work it is known how long it ``lasts_s`` where nobody disturbs."""
        self.close(self.env.now)
        self.state, self.since_s, self.lasts_s = {"kind": kind, **self.who, **about}, self.env.now, lasts_s

    def close(self, now_s: float) -> None:
        """Write the state until now, where there is one and it lasted."""
        if self.state is not None and now_s > self.since_s:
            to = {"progress_to": self.progress(now_s)} if "progress_from" in self.state else {}
            self.floor.rows.append(Row(now_s, self.since_s, **self.state, **to))
        self.state = None

    def progress(self, now_s: float) -> float:
        """How much of the work in hand is done, as a share."""
        before, spent_s = self.state["progress_from"], now_s - self.since_s
        return 1.0 if spent_s == self.lasts_s else before + (1.0 - before) * (spent_s / self.lasts_s)

    def at_once(self, kind: str, **about: Any) -> None:
        """Something happens to it that takes no time."""
        self.floor.rows.append(Row(self.env.now, self.env.now, kind, **self.who, **about))


class Job(Subject):
    """A job that comes into being now."""

    def __init__(self, floor: Floor, number: int, product: str):
        super().__init__(floor, job=number, product=product)
        self.number, self.product = number, product
        self.at_once("create")

    def works(self, lasts_s: float, k: int, done: float = 0.0, **about: Any) -> simpy.Timeout:
        """It is worked on from now on, a share of it ``done`` before; the event is the end of it."""
        self.now("work", lasts_s, k=k, progress_from=done, **about)
        return self.env.timeout(lasts_s)

    def leaves(self, kind: str = "finish", **about: Any) -> None:
        self.close(self.env.now)
        self.at_once(kind, **about)


class Worker(Subject):
    """A worker, at some place; what he does at a job is a row of the job. Workers stand in order of their names."""

    def __init__(self, floor: Floor, name: str, place: str):
        super().__init__(floor, worker=name)
        self.name, self.place = name, place
        self.waits()

    def __lt__(self, other: Worker) -> bool:
        return self.name < other.name

    def waits(self, kind: str = "wait", cause: str = "idle", **about: Any) -> None:
        """He is where he is: idle, or as ``kind`` and ``cause`` say."""
        self.now(kind, place_from=self.place, place_to=self.place, cause=cause, **about)

    def walks(self, place: str, walk_s: float, **about: Any) -> simpy.Timeout:
        """He is on his way from now on; the event is his arrival."""
        self.now("walk", place_from=self.place, place_to=place, **about)
        self.place = place
        return self.env.timeout(on_grid(walk_s))

    def performs(self, job: Job, lasts_s: float, k: int, done: float = 0.0, **about: Any) -> simpy.Timeout:
        """He works on a job from now on; the event is the end of it."""
        self.close(self.env.now)
        return job.works(lasts_s, k, done, worker=self.name, **about)
