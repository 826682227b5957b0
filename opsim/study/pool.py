"""Work on several processes that end when their parent ends, whatever ends it."""

import os
import signal
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context
from threading import Thread
from typing import Any

from opsim.whole import remove_unfinished

Prepare = Callable[[], Callable[[Any], Any]]
"""Makes in each process, once, what is done there with every item. It is sent there: it must be small.

NOTE: a process that dies before it has read its arguments blocks its parent for ever where they exceed a pipe's 64 kB.
"""


class ProcessLost(RuntimeError):
    """A process was killed from outside, as by an operating system that is out of memory."""


def pooled(prepare: Prepare, items: Iterable[Any], processes: int) -> Generator[Any, None, None]:
    """Results as they come. Whatever ends the iteration early also ends the processes, at once.

    Raises ProcessLost, and what the work itself raises.
    """
    context = get_context("spawn")  # a fork would copy the locks of whatever threads run by then
    parent_lives, parent_ends = context.Pipe(duplex=False)
    pool = ProcessPoolExecutor(processes, context, initializer=_begin, initargs=(prepare, parent_lives))
    try:
        with _without_control_c():
            futures = [pool.submit(_work, item) for item in items]
        for future in as_completed(futures):
            yield future.result()
        pool.shutdown()
    except BrokenProcessPool:
        raise ProcessLost("a process was killed (out of memory?)") from None
    finally:
        parent_ends.close()  # each process sees this, and ends
        _let_go(pool)
        pool.shutdown(wait=True, cancel_futures=True)
        parent_lives.close()


def _let_go(pool: ProcessPoolExecutor) -> None:
    """A process that ends while it sends a result leaves half of it in the pipe: the pool would wait for the rest for
    ever, as the pipe has a writer left in this very process. Without it the pool sees that nobody writes any more.
    """
    results = getattr(pool, "_result_queue", None)  # None once the pool is shut down
    if results is not None:
        results._writer.close()


@contextmanager
def _without_control_c() -> Iterator[None]:
    """Processes started in this block never see Ctrl-C, not even while they still import; here it comes afterwards."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


_here: dict[str, Any] = {}


def _begin(prepare: Prepare, parent_lives: Any) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
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
