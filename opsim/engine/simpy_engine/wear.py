"""What is left until a station breaks down: seconds by the clock, seconds at work, or cycles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import simpy

from opsim.clock import on_grid
from opsim.engine.rules import BREAKDOWN
from opsim.engine.simpy_engine.floor import Floor, cancel
from opsim.engine.simpy_engine.stops import Stop

WORN_OUT = "time until a breakdown is over"


@dataclass(slots=True, eq=False)
class Countdown:
    """Seconds until one kind of breakdown; they go by between ``run`` and ``hold``. Both may be said twice."""

    stop: Stop
    gaps: Iterator[float]
    left_s: float = 0.0
    since_s: float = 0.0
    alarm: simpy.Event | None = None

    def renew(self) -> None:
        """It begins anew, standing still."""
        self.left_s = on_grid(next(self.gaps))

    def run(self, floor: Floor) -> None:
        """The seconds go by from now on."""
        if self.alarm is None and self.left_s > 0:
            stop, self.since_s = self.stop, floor.now
            self.alarm = floor.alarm(self.left_s, BREAKDOWN, stop.station.rank, stop.rank, WORN_OUT, self)

    def hold(self, floor: Floor) -> None:
        """The seconds stand still; what is left is kept, to the last tick."""
        if self.alarm is not None:
            cancel(self.alarm)
            self.left_s, self.alarm = self.left_s - (floor.now - self.since_s), None

    def over(self) -> None:
        """Nothing is left: the breakdown is due."""
        self.left_s, self.alarm = 0.0, None


@dataclass(slots=True, eq=False)
class Cycles:
    """Operations until one kind of breakdown."""

    stop: Stop
    gaps: Iterator[float]
    left: float = 0.0

    def renew(self) -> None:
        """It begins anew."""
        self.left = next(self.gaps)


@dataclass(slots=True, eq=False)
class Wear:
    """All that counts towards the breakdowns of one station, as its meter. n_at_work : performances under way."""

    clock: list[Countdown] = field(default_factory=list)
    busy: list[Countdown] = field(default_factory=list)
    cycles: list[Cycles] = field(default_factory=list)
    n_at_work: int = 0

    def begin(self, floor: Floor) -> None:
        """A performance begins."""
        self.n_at_work += 1
        if self.n_at_work == 1:
            for countdown in self.busy:
                countdown.run(floor)

    def end(self, floor: Floor) -> None:
        """A performance ends, or is broken off."""
        self.n_at_work -= 1
        if self.n_at_work == 0:
            for countdown in self.busy:
                countdown.hold(floor)

    def cycle(self, floor: Floor) -> None:
        """An operation is done."""
        for cycles in self.cycles:
            cycles.left -= 1

    def stand_still(self, floor: Floor) -> None:
        """The station stops; what it does has been broken off before."""
        for countdown in self.clock:
            countdown.hold(floor)

    def go_on(self, floor: Floor) -> None:
        """The station is up; what is at work on it begins after this."""
        for countdown in self.clock:
            countdown.run(floor)

    def renew(self, stop: Stop) -> None:
        """A breakdown is repaired: what counts towards it begins anew."""
        every: list[Countdown | Cycles] = [*self.clock, *self.busy, *self.cycles]
        for one in every:
            if one.stop is stop:
                one.renew()
