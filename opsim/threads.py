"""BLAS on one thread, so that results do not depend on how many cores a machine has.

Whether this process may be forked, and threads of our own that keep still while it is.

A fork copies the memory of all threads, but only the thread that forks: a lock that another thread holds just then is
never let go in the copy. So a process is forked only where the kernel counts no thread but the main one and those here,
which are stopped between two ticks. Python gives the copy new locks for its own imports, glibc for its memory.

No search for garbage while many small things are made and none is in a cycle.
"""

from __future__ import annotations

import gc
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from functools import lru_cache
from typing import Any

_held: ContextVar[bool] = ContextVar("one BLAS thread is held", default=False)


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Whatever multiplies matrices inside does so on one thread.

    NOTE: finding the libraries takes 0.5 to 5 ms, a third of a short replication: they are looked for again only when
    something was imported since, and inside such a block another one does nothing. Nor is anything set where all have
    one thread anyhow, since setting takes 20 us, a hundredth of a short replication.
    """
    if _held.get():
        yield
        return
    token = _held.set(True)
    try:
        libraries = _libraries(len(sys.modules))
        if all(one.num_threads == 1 for one in libraries.lib_controllers):
            yield
        else:
            with libraries.limit(limits=1):
                yield
    finally:
        _held.reset(token)


@lru_cache(maxsize=1)
def _libraries(_n_modules: int) -> Any:
    """Those of BLAS that are loaded; ``_n_modules`` : imported so far, since a library comes with one."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")


def lean() -> None:
    """BLAS is loaded later with one thread, where it is not loaded yet: a process without threads can be forked.

    And garbage is looked for less often, since next to none is in cycles. For verbs that only run scenarios; what is
    fitted to recordings is sooner done on several threads.
    """
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    gc.set_threshold(20_000, 20, 20)


def freeze() -> None:
    """What is there now is no longer looked through for garbage, nor as the process ends: a tenth of a short run.

    Once in a process, and not where DuckDB is loaded, which complains on stderr of what is not given back at the end.
    """
    if "_duckdb" not in sys.modules and gc.get_freeze_count() == 0:
        gc.freeze()


TASKS = "/proc/self/task"
"""A folder a thread, as Linux counts them, those of libraries too."""
ENDING_S = 0.02
"""A thread that Python has joined may take so long until the kernel no longer counts it."""


class Ticking(threading.Thread):
    """Calls ``tick`` every ``every_s`` until ``stop``; never while this process is forked."""

    def __init__(self, tick: Callable[[], None], every_s: float) -> None:
        super().__init__(daemon=True)
        self._tick, self._every_s = tick, every_s
        self._stopped, self._still = threading.Event(), threading.Lock()

    def run(self) -> None:
        _ticking.add(self)
        while not self._stopped.wait(self._every_s):
            with self._still:
                self._tick()

    def stop(self) -> None:
        """Comes back when the last tick is over."""
        self._stopped.set()
        self.join()
        _ticking.discard(self)

    def hold(self) -> None:
        """Waits for the tick in hand; there is none until ``let_go``."""
        self._still.acquire()

    def let_go(self) -> None:
        self._still.release()


_ticking: set[Ticking] = set()
_held_tickers: list[Ticking] = []


def can_fork() -> bool:
    """Whether a fork of this process, by the thread that asks, copies no lock that stays locked."""
    if sys.platform != "linux" or threading.current_thread() is not threading.main_thread():
        return False  # elsewhere the libraries of the system itself do not bear it
    known, until_s = 1 + len(_ticking), time.monotonic() + ENDING_S
    while _threads() != known:
        if threading.active_count() != known or time.monotonic() > until_s:
            return False
        time.sleep(0.001)
    return True


def _threads() -> int:
    try:
        return len(os.listdir(TASKS))
    except OSError:
        return 0


def _hold() -> None:
    _held_tickers[:] = _ticking
    for thread in _held_tickers:
        thread.hold()


def _let_go() -> None:
    for thread in _held_tickers:
        thread.let_go()
    _held_tickers.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_hold, after_in_parent=_let_go, after_in_child=_ticking.clear)


@contextmanager
def without_collecting() -> Iterator[None]:
    """Around what reads or plans: to look for cycles meanwhile costs a fifth of the time, and more in a process that
    holds much else. What was made inside counts as old afterwards, so that not all of it is looked through at once.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            if gc.get_freeze_count() == 0:  # else somebody keeps things apart, as processes of a pool do
                gc.freeze()
                gc.unfreeze()
            gc.enable()
