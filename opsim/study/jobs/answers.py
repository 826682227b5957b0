"""Answers that are kept no longer than the process that asked for them.

Answers to jobs: computed where they are missing, kept as they come, read figure by figure.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import closing
from dataclasses import replace

import numpy as np

from opsim.engine import SIMPY
from opsim.pool import cores
from opsim.problems import Problem, ScenarioError
from opsim.results import Key
from opsim.study.engine_choice import Chosen
from opsim.study.jobs.evaluate import Engines, decided_by, loaded_of
from opsim.study.jobs.executors import Done, OnThisMachine, Work, by_executor
from opsim.study.jobs.job import Answer, Job, Missing, Point, Shard, ShardDone, Source, keys_in
from opsim.study.jobs.journal import Address, Journal


class InMemory:
    """As a Journal without files."""

    def __init__(self) -> None:
        self._found: dict[Address, tuple[list[Key], tuple[float, ...]]] = {}
        self._keys: dict[str, list[Key]] = {}

    def __contains__(self, address: Address) -> bool:
        return address in self._found

    def add(self, address: Address, answer: Answer) -> None:
        """Keep an answer."""
        keys = self._keys.setdefault(answer.figures, keys_in(answer.figures))
        self._found[address] = keys, answer.values

    def keys(self, address: Address) -> list[Key]:
        """The figures of an answer that is there."""
        return self._found[address][0]

    def values(self, address: Address) -> list[float]:
        """The numbers of an answer that is there, in the order of its keys."""
        return list(self._found[address][1])


Progress = Callable[[int, int], None]
SAID_EVERY_S = 0.2


class Answers:
    """The figures of a study's jobs. A study is a pure function of them: the same answers, the same bytes, whoever
    computed them, in whatever order, and after however many interruptions.
    """

    def __init__(
        self,
        source: Source,
        kept: Journal | InMemory | None = None,
        *,
        processes: int | None = None,
        executor: Executor | None = None,
        progress: Progress | None = None,
        shard: Shard | None = None,
        compute: bool = True,
        keep: Sequence[str] | None = None,
        engine: str = SIMPY,
        chosen: Chosen | None = None,
    ):
        """kept : where answers are and go; None: in memory only (see ``open_study`` for a folder)

        processes : here; None takes as many as pay. executor : instead, any that takes picklable functions
        shard     : only its part of the first jobs asked for is computed, then ShardDone is raised
        compute   : False raises Missing where an answer is not there
        keep      : figures that are kept of each replication, where these are more than those of the source
        engine    : ``simpy``, ``fast`` or ``auto``: the same answers (opsim/engine/choice.py)
        chosen    : told each engine that is used; what it gives back is told how far the compiling is
        """
        self.source, self.progress = source, progress
        self._kept = InMemory() if kept is None else kept
        self._computing = source if keep is None else replace(source, kpis=tuple(keep))
        self._here = OnThisMachine(self._computing, processes)
        self._executor, self._shard, self._compute = executor, shard, compute
        at_once = getattr(executor, "_max_workers", None) if executor is not None else processes
        self.engines = Engines(self._computing, engine, chosen, at_once or cores())
        self._decided: dict[Point, str] = {}
        self._asked: dict[Job, None] = {}
        self._done, self._said_s = 0, 0.0

    @property
    def asked(self) -> Sequence[Job]:
        """Every job asked for so far, in the order of the first asking."""
        return list(self._asked)

    def addresses(self) -> Iterator[Address]:
        """Where the answers to every job asked for are kept."""
        return map(self._address, self._asked)

    def check(self, points: Iterable[Point]) -> None:
        """Raise ScenarioError with everything that is wrong with the changes of any of some points."""
        wrong: list[Problem] = []
        for point in dict.fromkeys(points):
            try:
                loaded_of(self.source, point)
            except ScenarioError as error:
                wrong += error.problems
        if wrong:
            raise ScenarioError(dict.fromkeys(wrong))

    def ensure(self, jobs: Sequence[Job]) -> None:
        """Compute what is missing of some jobs, point by point in their order. Whatever stops it, what is finished is
        kept. Raises what computing raises, OSError where an answer cannot be kept.
        """
        jobs = list(dict.fromkeys(jobs))
        self._asked.update(dict.fromkeys(jobs))
        if not self._compute:
            self._refuse_missing(jobs)
        elif self._shard is None:
            self._find(jobs)
        else:
            mine = self._shard.takes(jobs)
            self._find(mine)
            raise ShardDone(len(mine), len(jobs), sum(self._address(job) not in self._kept for job in jobs))

    def values(self, jobs: Sequence[Job], keys: Sequence[Key]) -> np.ndarray:
        """(J, K) figures of jobs, computed where they are missing; nan where a job has no such figure."""
        self.ensure(jobs)
        found = np.full((len(jobs), len(keys)), np.nan)
        columns: dict[int, list[tuple[int, int]]] = {}
        for row, job in enumerate(jobs):
            address = self._address(job)
            of = self._kept.keys(address)
            if id(of) not in columns:
                at = {key: place for place, key in enumerate(of)}
                columns[id(of)] = [(column, at[key]) for column, key in enumerate(keys) if key in at]
            numbers = self._kept.values(address)
            for column, place in columns[id(of)]:
                found[row, column] = numbers[place]
        return found

    def has(self, jobs: Sequence[Job], keys: Sequence[Key]) -> np.ndarray:
        """(J, K) whether a job has such a figure, be it nan; of jobs that are there."""
        sets: dict[int, list[bool]] = {}
        rows = []
        for of in (self._kept.keys(self._address(job)) for job in jobs):
            if id(of) not in sets:
                there = set(of)
                sets[id(of)] = [key in there for key in keys]
            rows.append(sets[id(of)])
        return np.array(rows, dtype=bool).reshape(len(jobs), len(keys))

    def keys(self, jobs: Sequence[Job]) -> list[Key]:
        """(kpi, subject, part, unit) of every figure that some of the jobs have: by kpi as asked for, then by name."""
        self.ensure(jobs)
        sets = {id(of): of for of in (self._kept.keys(self._address(job)) for job in jobs)}
        place = {kpi: number for number, kpi in enumerate(self.source.kpis)}
        found = {key for of in sets.values() for key in of if key[0] in place}
        return sorted(found, key=lambda key: (place[key[0]], key))

    def close(self) -> None:
        """End what was begun for computing: processes of this machine."""
        self._here.close()

    def _find(self, jobs: Sequence[Job]) -> None:
        left = [job for job in jobs if self._address(job) not in self._kept]
        if not left:
            return
        self.engines.prepare(left, here=self._executor is None)
        missing = [Work(job, self._decided_by(job.point), self.engines.of(job.point)) for job in left]
        total = self._done + len(missing)
        with closing(self._results(missing)) as results:
            for work, answer in results:
                self._kept.add((work.decided, *work.job.key[1:]), answer)
                self._done += 1
                self._say(total)

    def _results(self, missing: Sequence[Work]) -> Generator[Done, None, None]:
        if self._executor is not None:
            return by_executor(self._executor, self._computing, missing)
        return self._here.results(missing)

    def _refuse_missing(self, jobs: Sequence[Job]) -> None:
        places = [place for place, job in enumerate(jobs) if self._address(job) not in self._kept]
        if places:
            raise Missing(places, len(jobs))

    def _say(self, total: int) -> None:
        """Tell how far it is, seldom enough that many small batches are not many lines."""
        now = time.monotonic()
        if self.progress is not None and (now - self._said_s >= SAID_EVERY_S or self._done == total):
            self.progress(self._done, total)
            self._said_s = now

    def _address(self, job: Job) -> Address:
        return self._decided_by(job.point), job.key[1], job.key[2]

    def _decided_by(self, point: Point) -> str:
        if point not in self._decided:
            self._decided[point] = decided_by(self.source, point)
        return self._decided[point]
