"""How numba compiles what the engine is made of, and how that is shared out between processes.

This process takes from the beginning of a list, others from its end; nothing twice. So each of two compiles its own
half of the files, and with it few of the helpers that the other one compiles.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from threading import Condition, Thread
from typing import Any, NamedTuple, TypeVar

import numba
from numba import extending
from numba.core.errors import NumbaError

from opsim.engine.fast_engine.machine.code_cache import Code, say

F = TypeVar("F", bound=Callable)
intrinsic: Any = extending.intrinsic
NO_WRAPPERS: dict[str, Any] = {"nogil": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
"""Nobody calls these from Python, so nothing is made for that."""


OTHER_NUMBA = "compiled as numba does it by itself, which takes longer: it may be another numba than is known here"
FAILURES = (NumbaError, RuntimeError, AttributeError, TypeError, LookupError, ValueError, AssertionError)
"""NOTE: what comes of inner parts that are others than they were. What is wrong with a function is raised the second
time too; and a full memory, or an interruption, is nothing to go on after."""


def _compiler() -> Any:
    """numba's compiler with less around it; None where this numba is another one than it was written for."""
    try:
        from opsim.engine.fast_engine.machine import compiler
    except (ImportError, AttributeError) as error:
        say("the fast engine", OTHER_NUMBA, error)
        return None
    return compiler


LESS = _compiler()


def inlined(function: F) -> F:
    """A small function that is compiled into each step that calls it. It may not call itself, in no way round.

    Used in another file, it belongs into ``parts/`` or ``machine/``: see ``stamp``.
    """
    made: F = _helper(function)
    return made


def forced(function: F) -> F:
    """As ``inlined``, and put into its callers however long it is."""
    made: F = _helper(function, forceinline=True)
    return made


def _helper(function: Callable, **options: bool) -> Any:
    if LESS is not None:
        try:
            return LESS.helper(**options)(function)
        except (TypeError, AttributeError) as error:
            say(function.__qualname__, OTHER_NUMBA, error)
    wanted: dict[str, Any] = {**NO_WRAPPERS, **options}
    return numba.njit(**wanted)(function)


class Compiled(NamedTuple):
    """Either the machine code of a function; or at : its address, alive : what its machine code lives with"""

    code: Code | None = None
    at: int = 0
    alive: object = None


def compiled(signature: Any, function: Callable) -> Compiled:
    """A function compiled for one signature: as shortly as can be, and else as numba does it by itself."""
    if LESS is None:
        return by_numba(signature, function)
    try:
        return Compiled(LESS.compiled_step(signature, function))
    except FAILURES as error:
        made = by_numba(signature, function)
        say(function.__qualname__, OTHER_NUMBA, error)
        return made


def by_numba(signature: Any, function: Callable) -> Compiled:
    """The same by what numba offers to everybody; it keeps the machine code in files of its own."""
    made, known_by = kept(signature, function), tuple(signature.args)
    if known_by not in made.overloads:  # another source's: numba's files are mixed up where two versions save at once
        made = numba.njit(signature, **NO_WRAPPERS)(function)
    result = made.overloads[known_by]
    return Compiled(at=int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name)), alive=made)


def kept(signature: Any, function: Callable) -> Any:
    """A function compiled for one signature, its machine code kept on disk, or not where nothing can be written."""
    try:
        return numba.njit(signature, cache=True, **NO_WRAPPERS)(function)
    except RuntimeError as error:  # numba: "cannot cache function ...: no locator available"
        if "locator" not in str(error):
            raise
        return numba.njit(signature, **NO_WRAPPERS)(function)


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
