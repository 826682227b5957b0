"""Whether this process may be forked, and threads of our own that keep still while it is.

A fork copies the memory of all threads, but only the thread that forks: a lock that another thread holds just then is
never let go in the copy. So a process is forked only where the kernel counts no thread but the main one and those here,
which are stopped between two ticks. Python gives the copy new locks for its own imports, glibc for its memory.
"""

import os
import sys
import threading
import time
from collections.abc import Callable

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
_held: list[Ticking] = []


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
    _held[:] = _ticking
    for thread in _held:
        thread.hold()


def _let_go() -> None:
    for thread in _held:
        thread.let_go()
    _held.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_hold, after_in_parent=_let_go, after_in_child=_ticking.clear)
