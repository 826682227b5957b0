"""Progress on stderr: a bar with the time left on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import click

from opsim.forking import Ticking

Report = Callable[..., None]
"""``report(done, total, label="")``."""
LINE_EVERY_S = 5.0
TICK_S = 0.1


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

        def report(done: int, total: int, label: str = "") -> None:
            bar.update(task, completed=done, total=total, description=_titled(what, label))

        try:
            yield report
        finally:
            clock.stop()


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

    def _left(self, now: float) -> str:
        """The time left, as fast as it went since the clock started; nothing before the first step and at the end."""
        done, total = self.count
        if done >= total or done <= self.first:
            return ""
        return f", {(now - self.started) / (done - self.first) * (total - done):.0f} s left"


def _titled(what: str, label: str) -> str:
    return f"{what}: {label}" if label else what
