"""Steps called from Python at their addresses, without numba's wrappers; signals wait until something may be raised.

NOTE: Python handles a signal as it enters a function, before any ``try`` in it. In a function that compiled code calls,
what a handler raises there would be printed and lost, and compiled code would go on with an answer that nobody gave.
"""

from __future__ import annotations

import builtins
import ctypes
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import current_thread, local, main_thread
from typing import Any, TypeVar

from opsim.engine.fast_engine.machine.steps import step_of
from opsim.engine.fast_engine.machine.table import FAILURES, TABLE, entry

_POINTER, _NUMBER = ctypes.c_void_p, ctypes.c_int64


def caller(call: Any) -> Callable[..., int]:
    """A function of Python for a step of a floor's address and of a number, or another address; so is its answer.

    It raises what the step does.
    """
    line = step_of(call).line
    made = ctypes.CFUNCTYPE(_NUMBER, _POINTER, _POINTER, _NUMBER, _NUMBER)

    def called(floor: int, given: int = 0) -> int:
        answer = _NUMBER(0)
        state = made(entry())(int(TABLE[line]), ctypes.byref(answer), floor, given)
        if state:
            name, words = FAILURES[state]
            raise getattr(builtins, name)(*([words] if words else []))
        return answer.value

    return called


T = TypeVar("T")
_NAMES = ("SIGINT", "SIGTERM", "SIGBREAK", "SIGHUP", "SIGALRM", "SIGUSR1", "SIGUSR2")
SIGNALS = tuple(getattr(signal, name) for name in _NAMES if hasattr(signal, name))


class Waiting:
    """Signals of one run, with the handlers that they are for. may_raise : whether those may be called at once

    over : the run has ended, and so has the waiting, should this be the handler of a signal still
    """

    def __init__(self) -> None:
        self.handlers: dict[int, Callable[..., Any]] = {}
        self.may_raise = self.over = False
        self._came: list[tuple[int, Any]] = []

    def comes(self, number: int, frame: Any) -> None:
        """The handler of all of them meanwhile."""
        self._came.append((number, frame))
        if self.may_raise or self.over:
            self.handle()

    def handle(self) -> None:
        """Have those handled that wait. Raises what their handlers raise, after which no more are handled at once."""
        before, self.may_raise = self.may_raise, False
        while self._came:
            number, frame = self._came.pop(0)
            handler = self._handler_of(number)
            if callable(handler):
                handler(number, frame)
        self.may_raise = before

    def _handler_of(self, number: int) -> Any:
        """Of now: the handler of the first signal may have changed what others do."""
        current = signal.getsignal(number)
        return self.handlers[number] if current == self.comes else current


class _Here(local):
    """Signals come to the main thread alone: others have none that wait."""

    waiting: Waiting | None = None


_HERE = _Here()


@contextmanager
def signals_wait() -> Iterator[Waiting]:
    """In this block signals that have a handler in Python wait; those that came are handled at its end."""
    waiting, outside = Waiting(), _HERE.waiting
    if current_thread() is not main_thread():
        yield waiting
        return
    try:
        _HERE.waiting = waiting
        for number in SIGNALS:
            if callable(handler := signal.getsignal(number)):
                waiting.handlers[number] = handler
                signal.signal(number, waiting.comes)
        yield waiting
    finally:
        _HERE.waiting, waiting.over = outside, True
        for number, handler in waiting.handlers.items():
            if signal.getsignal(number) == waiting.comes:
                signal.signal(number, handler)
        waiting.handle()


def handled(work: Callable[..., T], *arguments: Any) -> T:
    """The answer of what may take long, signals being handled meanwhile. To be called where all errors are caught."""
    waiting = _HERE.waiting
    if waiting is None:
        return work(*arguments)
    try:
        waiting.may_raise = True
        waiting.handle()
        return work(*arguments)
    finally:
        waiting.may_raise = False
