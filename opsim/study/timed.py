"""One replication by one engine, with the time it takes and however it ends."""

from __future__ import annotations

import time
from dataclasses import dataclass

from opsim.engine.choice import Choice, Run, runner_of
from opsim.log import EventLog
from opsim.plan import Plan

QUICK_S = 2.0


@dataclass(frozen=True)
class Timed:
    """logs : of one replication, once or twice; seconds : of the last time; error : what was raised instead"""

    logs: tuple[EventLog, ...] = ()
    seconds: float = 0.0
    error: Exception | None = None

    @property
    def rows(self) -> int:
        """Of the log."""
        return len(self.logs[0]) if self.logs else 0

    @property
    def said(self) -> str:
        """The error in words; nothing where there is none."""
        return "" if self.error is None else f"{type(self.error).__name__}: {self.error}"

    @property
    def words(self) -> str:
        """What came of it."""
        return f"ended with {self.said}" if self.said else f"wrote {self.rows:,} rows"


def timed(choice: Choice, plan: Plan, replication: int) -> Timed:
    """A quick first run is done twice: the first one also loads what it needs, and is on a floor that nobody used."""
    run = runner_of(choice)
    try:
        first = _once(run, plan, replication)
        if replication or first.seconds >= QUICK_S:
            return first
        again = _once(run, plan, replication)
    except Exception as error:  # whatever it is: the other engine may not end so
        return Timed(error=error)
    return Timed((*first.logs, *again.logs), again.seconds)


def _once(run: Run, plan: Plan, replication: int) -> Timed:
    started = time.perf_counter()
    log = run(plan, replication)
    return Timed((log,), time.perf_counter() - started)
