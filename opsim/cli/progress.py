"""Progress on stderr: a bar with the time left on a terminal, plain lines elsewhere.

The option ``--engine`` of all verbs that run something, and what is said of the engine that is taken.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

import click

from opsim.engine import AUTO, ENGINES, SIMPY

if TYPE_CHECKING:
    from opsim.engine.choice import Choice, Told
    from opsim.study.engine_choice import Chosen

LINE_EVERY_S = 5.0
TICK_S = 0.1


class Report(Protocol):
    """What is called while something goes on."""

    def __call__(self, done: int, total: int, label: str = "") -> None:
        """So much is done."""

    def once(self, done: int, total: int, label: str) -> None:
        """As a call, of something that goes before: where there is no terminal one line at its beginning is enough."""

    def say(self, line: str) -> None:
        """A line that stays."""


@contextmanager
def progress(what: str) -> Iterator[Report]:
    """Give a function to call with (done, total) or (done, total, label) while the block runs."""
    if sys.stderr.isatty():
        with _bar(what) as report:
            yield report
    else:
        yield _Lines(what)


@contextmanager
def _bar(what: str) -> Iterator[Report]:
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    from opsim.threads import Ticking

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True, auto_refresh=False) as bar:
        task = bar.add_task(what, total=None)
        clock = Ticking(bar.refresh, TICK_S)  # not rich's own thread, beside which a fork would not be safe
        clock.start()

        try:
            yield _Bar(what, bar, task)
        finally:
            clock.stop()


class _Bar:
    """A bar on a terminal."""

    def __init__(self, what: str, bar: Any, task: Any) -> None:
        self._what, self._bar, self._task = what, bar, task
        self._timed: str | None = None

    def __call__(self, done: int, total: int, label: str = "") -> None:
        if self._timed is not None:  # the clock of what went before says nothing of this
            self._bar.reset(self._task)
            self._timed = None
        self._bar.update(self._task, completed=done, total=total, description=_titled(self._what, label))

    def once(self, done: int, total: int, label: str) -> None:
        self(done, total, label)
        self._timed = label

    def say(self, line: str) -> None:
        self._bar.console.print(line, markup=False, highlight=False, soft_wrap=True)


class _Lines:
    """A line at the first and the last step of each label, and every few seconds between.

    The clock starts anew where a label begins to count anew, and goes on where it only names the next step.
    """

    def __init__(self, what: str) -> None:
        self.what, self.started, self.last = what, time.monotonic(), 0.0
        self.label: str | None = None
        self.first, self.count = 0, (0, 0)

    def __call__(self, done: int, total: int, label: str = "") -> None:
        now = time.monotonic()
        if label != self.label:
            if self.label is not None and (done < self.count[0] or total != self.count[1]):
                self.started, self.first = now, done
            self.label, self.last = label, 0.0
        self.count = done, total
        if done < total and now - self.last < LINE_EVERY_S:
            return
        self.last = now
        click.echo(f"{_titled(self.what, label)}: {done} of {total}{self._left(now)}", err=True)

    def once(self, done: int, total: int, label: str) -> None:
        if done < total and label != self.label:
            click.echo(_titled(self.what, label), err=True)
        self.label, self.started, self.count = label, time.monotonic(), (done, total)

    def say(self, line: str) -> None:
        click.echo(line, err=True)

    def _left(self, now: float) -> str:
        """The time left, as fast as it went since the clock started; nothing before the first step and at the end."""
        done, total = self.count
        if done >= total or done <= self.first:
            return ""
        return f", {(now - self.started) / (done - self.first) * (total - done):.0f} s left"


def _titled(what: str, label: str) -> str:
    return f"{what}: {label}" if label else what


COMPILING = "compiling the fast engine (once)"
NOT_KEPT = "compiling the fast engine (each time, as it can be kept nowhere: set NUMBA_CACHE_DIR)"


class EngineWord(click.Choice):  # type: ignore[type-arg]  # of click 8.1 it takes none
    """One of the engines; of another word the nearest one is said."""

    def __init__(self) -> None:
        super().__init__(ENGINES)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """Raises BadParameter."""
        from opsim.engine.choice import known

        try:
            return known(value)
        except ValueError as error:
            self.fail(str(error).removeprefix("engine: "), param, ctx)


def engine_option(default: str | None = SIMPY) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """default : None where it is known later whether anything is run; that is SIMPY then"""
    words = "What runs it; the results are the same. auto: the fast one where that is sooner.  [default: simpy]"
    return click.option("--engine", type=EngineWord(), default=default, help=words)


def telling(what: str, report: Report, said: set[str] | None = None) -> Chosen:
    """Says which engine ``auto`` takes, and that the fast one is compiled; ``what`` is being done.

    said : sentences that are not said again, and what is said is added to them
    """
    before = set[str]() if said is None else said

    def chosen(choice: Choice) -> Told | None:
        if choice.asked == AUTO and choice.words not in before:
            report.say(f"{what}: {choice.words}")
            before.add(choice.words)
        return lambda done, total: report.once(done, total, _compiling())

    return chosen


def _compiling() -> str:
    from opsim.engine.fast_engine import is_kept

    return COMPILING if is_kept() else NOT_KEPT
