"""Work on several processes that end when their parent ends, whatever ends it."""

from __future__ import annotations

import gc
import os
import pickle
import signal
import sys
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from itertools import islice
from multiprocessing import get_context
from threading import Thread
from typing import Any

from opsim.files import remove_unfinished
from opsim.threads import can_fork

Prepare = Callable[[], Callable[[Any], Any]]
"""Makes in each process, once, what is done there with every item. It may be sent there: it must be small.

NOTE: a process that dies before it has read its arguments blocks its parent for ever where they exceed a pipe's 64 kB.
"""
FORKED_S, SPAWNED_S = 0.3, 4.0
"""Seconds of work left below which one process is sooner done: a fork takes 0.03 s, a new process 2 s to start."""
WAITING = 4
"""Items handed out ahead for each process: none is ever idle, and a million items are not a million futures."""


def cores() -> int:
    """Processors that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class ProcessLost(RuntimeError):
    """A process was killed from outside, as by an operating system that is out of memory."""


def pays(seconds_left: float) -> bool:
    """Whether so much work, as done by one process, is sooner done by several."""
    return seconds_left > (FORKED_S if can_fork() else SPAWNED_S)


class Pool:
    """Processes that stay for several rounds of items, until ``close``; whatever ends a round early ends them at once.

    They are forked where that is safe (opsim/threads.py): they have then what this process has imported and read.
    """

    def __init__(self, prepare: Prepare, processes: int) -> None:
        fork = can_fork()
        context: Any = get_context("fork" if fork else "spawn")
        self._ahead = WAITING * processes
        self._hides = None if fork or b"__main__" in pickle.dumps(prepare) else sys.modules["__main__"]
        self._parent_lives, self._parent_ends = context.Pipe(duplex=False)
        begin = (prepare, self._parent_lives, self._parent_ends if fork else None)
        self._pool = ProcessPoolExecutor(processes, context, initializer=_begin, initargs=begin)

    def results(self, items: Iterable[Any], meanwhile: Callable[[], None] | None = None) -> Generator[Any, None, None]:
        """Results as they come, in any order; ``meanwhile`` is called once, when all processes have something to do.

        Raises ProcessLost, and what the work itself raises.
        """
        left, whole = iter(items), False
        try:
            running = self._submitted(left, self._ahead)
            if meanwhile is not None:
                meanwhile()
            while running:
                done, running = wait(running, return_when=FIRST_COMPLETED)
                running |= self._submitted(left, len(done))
                for future in done:
                    yield future.result()
            whole = True
        except BrokenProcessPool:
            raise ProcessLost("a process was killed (out of memory?)") from None
        finally:
            if not whole:
                self._end()

    def close(self) -> None:
        """Processes end by themselves, having nothing more to do."""
        self._pool.shutdown()
        self._end()

    def _submitted(self, items: Iterator[Any], n: int) -> set[Future[Any]]:
        with _without_signals(), _hidden(self._hides):
            return {self._pool.submit(_work, item) for item in islice(items, n)}

    def _end(self) -> None:
        self._parent_ends.close()  # each process sees this, and ends
        _let_workers_go(self._pool)
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._parent_lives.close()


def pooled(
    prepare: Prepare, items: Iterable[Any], processes: int, meanwhile: Callable[[], None] | None = None
) -> Generator[Any, None, None]:
    """Results as they come, in any order, of a Pool for these items alone; raises what ``Pool.results`` raises."""
    with closing(Pool(prepare, processes)) as pool, closing(pool.results(items, meanwhile)) as results:
        yield from results


def _let_workers_go(pool: ProcessPoolExecutor) -> None:
    """A process that ends while it sends a result leaves half of it in the pipe: the pool would wait for the rest for
    ever, as the pipe has a writer left in this very process. Without it the pool sees that nobody writes any more.
    """
    results = getattr(pool, "_result_queue", None)  # None once the pool is shut down
    if results is not None:
        results._writer.close()


@contextmanager
def _without_signals() -> Iterator[None]:
    """Processes started in this block never see Ctrl-C, not even while they still import; here it comes afterwards.

    Nor SIGTERM before they know what to do then: a process that is ended while it still has what this one does would go
    on, and be waited for for ever.
    """
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _hidden(script: Any) -> Iterator[None]:
    """Processes started in this block do not run the user's script again, as they do to find what stands in it.

    Else a script whose work is not below ``if __name__ == "__main__":`` would start processes from its processes, which
    Python refuses.
    """
    if script is None:
        yield
        return
    kept = {name: script.__dict__[name] for name in ("__spec__", "__file__") if name in script.__dict__}
    script.__dict__.update(dict.fromkeys(kept))
    try:
        yield
    finally:
        script.__dict__.update(kept)


_here: dict[str, Any] = {}


def _begin(prepare: Prepare, parent_lives: Any, parent_ends: Any) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    if parent_ends is not None:
        parent_ends.close()  # a copy: while it is open, nobody would see that the parent ended
        gc.freeze()  # what was there before the fork is not looked through again and again
    Thread(target=_end_with_parent, args=(parent_lives,), daemon=True).start()
    try:
        _here["work"] = prepare()
    except Exception as error:  # said by the first item, as a pool would only say that it is broken
        _here["failed"] = error


def _end_with_parent(parent_lives: Any) -> None:
    """Nothing is ever sent: the pipe is read until the parent closes it, or the system does because the parent died."""
    try:
        parent_lives.recv_bytes()
    except (EOFError, OSError):
        remove_unfinished()
        os._exit(1)


def _work(item: Any) -> Any:
    if "failed" in _here:
        raise _here["failed"]
    return _here["work"](item)
