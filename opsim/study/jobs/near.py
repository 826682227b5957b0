"""Jobs on this machine: here, or on several processes where that pays."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Sequence
from functools import partial

from opsim.study.jobs.answer import Answer
from opsim.study.jobs.evaluate_here import answer
from opsim.study.jobs.far_away import Work
from opsim.study.jobs.source import Source
from opsim.study.pool import Pool, cores, pays
from opsim.study.replicate import LOADING_S

Done = tuple[Work, Answer]


class OnThisMachine:
    """Processes that stay from one batch of jobs to the next, once there was one that was worth them."""

    def __init__(self, source: Source, processes: int | None):
        """processes : None takes one, and all cores where what is left to do is worth it"""
        self._source, self._processes = source, processes
        self._pool: Pool | None = None

    def results(self, work: Sequence[Work]) -> Generator[Done, None, None]:
        """Answers as they come. Whatever ends it early also ends the processes."""
        left = list(work)
        if self._pool is None:
            left = yield from self._until_known(left)
        if not left:
            return
        if self._pool is None:
            self._pool = Pool(partial(_prepared, self._source), self._processes or cores())
        pool, self._pool = self._pool, None
        yield from pool.results(left)
        self._pool = pool

    def close(self) -> None:
        """End the processes, where there are any."""
        if self._pool is not None:
            self._pool.close()
            self._pool = None

    def _until_known(self, left: list[Work]) -> Generator[Done, None, list[Work]]:
        """Do jobs here until it is known whether several processes pay; returned is what is left for them."""
        if self._processes is not None and min(self._processes, len(left)) > 1:
            return left
        one = self._processes is not None or cores() == 1
        took_s: list[float] = []
        while left:
            started = time.perf_counter()
            yield _do(self._source, left.pop(0))
            took_s.append(time.perf_counter() - started)
            known = len(took_s) > 1 or took_s[0] > LOADING_S
            if not one and known and pays(min(took_s) * len(left)):
                break
        return left


def _prepared(source: Source) -> Callable[[Work], Done]:
    return partial(_do, source)


def _do(source: Source, one: Work) -> Done:
    return one, answer(source, one.job, one.engine)
