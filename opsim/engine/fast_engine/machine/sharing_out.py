"""Compiling shared out: this process takes from the beginning of a list, others from its end; nothing twice.

So each of two compiles its own half of the files, and with it few of the helpers that the other one compiles.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from threading import Condition, Thread
from typing import NamedTuple

WORTH_HELP = 16
"""So many jobs are worth other processes: each takes some 0.1 s, and a process 0.7 s to begin."""
MOST_PROCESSES = 4
PATIENCE_S = 60.0
"""For what another process has taken last; then it is done here."""
Told = Callable[[int, int], None]


class Job(NamedTuple):
    """name : by which another process knows what to do, to disk; empty: none does; here : does it in this one"""

    name: str
    here: Callable[[], object]


class Work:
    """Jobs, each done once."""

    def __init__(self, jobs: Iterable[Job]):
        self._left = deque(jobs)
        self._elsewhere = 0
        self._changed = Condition()

    @property
    def n_open(self) -> int:
        """Those not done yet, as far as is known."""
        return len(self._left) + self._elsewhere

    def first(self) -> Job | None:
        """The next one to be done here; None: all are done. Waits for what was taken elsewhere."""
        with self._changed:
            self._changed.wait_for(lambda: self._left or not self._elsewhere, PATIENCE_S)
            return self._left.popleft() if self._left else None

    def last(self) -> Job | None:
        """One to be done elsewhere."""
        with self._changed:
            if not self._left or not self._left[-1].name:
                return None
            self._elsewhere += 1
            return self._left.pop()

    def done(self, job: Job, *, well: bool) -> None:
        """One that was taken elsewhere; it is to be done here, where that did not go well."""
        with self._changed:
            self._elsewhere -= 1
            if not well:
                self._left.append(job)
            self._changed.notify_all()


@contextmanager
def helped(work: Work, command: list[str]) -> Iterator[None]:
    """Other processes do some of the work: each says a line when it is ready for a job, and is given its name."""
    processes = [found for _ in range(n_helpers()) if (found := _begun(command)) is not None]
    for one in processes:
        Thread(target=_serve, args=(work, one), daemon=True).start()
    try:
        yield
    finally:
        for one in processes:
            one.kill()
            one.wait()


def n_helpers() -> int:
    """None where there is one processor."""
    allowed = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(allowed, MOST_PROCESSES) - 1


def _begun(command: list[str]) -> subprocess.Popen[str] | None:
    """None: no process can be begun. NOTE: -P, as nothing of the folder that somebody stands in is to be imported."""
    pipe, nowhere = subprocess.PIPE, subprocess.DEVNULL
    if not sys.executable or getattr(sys, "frozen", False):  # it is no Python
        return None
    with suppress(OSError):
        return subprocess.Popen([sys.executable, "-P", *command], text=True, stdin=pipe, stdout=pipe, stderr=nowhere)
    return None


def _serve(work: Work, process: subprocess.Popen[str]) -> None:
    """Give a process jobs until there are none, or until it ends."""
    job = None
    with suppress(OSError, ValueError):  # it has ended
        while process.stdout is not None and process.stdin is not None and process.stdout.readline():
            if job is not None:
                work.done(job, well=True)
            if (job := work.last()) is None:
                return
            process.stdin.write(job.name + "\n")
            process.stdin.flush()
    if job is not None:
        work.done(job, well=False)
