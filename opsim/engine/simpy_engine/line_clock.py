"""The clock of a paced line: it stands while the line stands, and what it is set to comes so much later."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import simpy

from opsim.engine.rules import CALENDAR
from opsim.engine.simpy_engine.floor import Floor, Handler, cancel

LINE_CLOCK = "a paced line's clock"
What = Callable[[Floor], None]


@dataclass(slots=True, eq=False)
class Due:
    """What is to be done when the clock shows a time; rank, number : its place among the reports of that instant."""

    clock: LineClock
    at_s: float
    rank: int
    number: int
    what: What
    event: simpy.Event | None = None


@dataclass(slots=True, eq=False)
class LineClock:
    """shown_s : what it showed at ``since_s``, when it last began to run or to stand; pending : what it is set to

    NOTE: all times are on the grid, so sums and differences are exact.
    """

    shown_s: float = 0.0
    since_s: float = 0.0
    runs: bool = True
    pending: dict[Due, None] = field(default_factory=dict)

    def now_s(self, now: float) -> float:
        """What it shows at an instant."""
        return self.shown_s + (now - self.since_s) if self.runs else self.shown_s

    def at(self, floor: Floor, at_s: float, rank: int, number: int, what: What) -> None:
        """Do something when it shows a time that is to come."""
        due = Due(self, at_s, rank, number, what)
        self.pending[due] = None
        if self.runs:
            self._set(floor, due)

    def stop(self, floor: Floor) -> None:
        """It stands from now on."""
        self.shown_s, self.since_s, self.runs = self.now_s(floor.now), floor.now, False
        for due in self.pending:
            if due.event is not None:
                cancel(due.event)

    def start(self, floor: Floor) -> None:
        """It runs again."""
        self.since_s, self.runs = floor.now, True
        for due in self.pending:
            self._set(floor, due)

    def _set(self, floor: Floor, due: Due) -> None:
        due.event = floor.alarm(due.at_s - self.now_s(floor.now), CALENDAR, due.rank, due.number, LINE_CLOCK, due)


def _comes(floor: Floor, due: Due) -> None:
    del due.clock.pending[due]
    due.what(floor)


HANDLERS: dict[str, Handler] = {LINE_CLOCK: _comes}
