"""Whether a worker is there: his shifts and pauses to come, and which of them he is in."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field

from opsim.clock import TICKS_PER_S, on_grid
from opsim.engine.rules import CALENDAR
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Worker
from opsim.plan import Duty, Pause

GONE, HERE, LEAVING, PAUSED = range(4)
END, BEGIN, PAUSE = range(3)
"""What changes, in the order in which changes of one instant are applied."""

DUTY = "duty"
"""What restricts somebody who is about to go, or is back for a job that waits for him: he is sent nowhere else."""

Moment = tuple[float, int, Duty, Pause | Duty | None]
"""(when, what, in which shift, which pause or, at the end of a shift, which shift follows at once)"""


@dataclass(slots=True, eq=False)
class Presence:
    """worker : who; to_come : what his calendar still holds, in order; due : the next of it

    state  : gone, here, leaving (he will go as soon as he may), or in a pause, on the way to its place included
    duty   : the shift he is on, or stays on after; None: he has none now
    goes   : whether he is leaving because his shift is over, not for a pause
    misses : whether he is absent from the shift that has followed at once on the one he is leaving
    owed   : pauses that have begun and that he has not had; pause : the one he is in
    overtime : whether he stays on after his shift; undecided : whether that is still to be seen, in this instant
    """

    worker: Worker
    to_come: Iterator[Moment]
    due: Moment | None = None
    state: int = GONE
    duty: Duty | None = None
    goes: bool = False
    misses: bool = False
    owed: deque[Pause] = field(default_factory=deque)
    pause: Pause | None = None
    overtime: bool = False
    undecided: bool = False

    @property
    def shift_on(self) -> Duty:
        """The shift of somebody who has one now."""
        assert self.duty is not None
        return self.duty


def moments(duties: tuple[Duty, ...]) -> Iterator[Moment]:
    """All changes in order of time, on the grid; a shift that the horizon cuts has no end."""
    found: list[Moment] = []
    for duty, after in zip(duties, (*duties[1:], None)):
        found.append((_exact(duty.start_s), BEGIN, duty, None))
        for pause in duty.pauses:
            if pause.start_s < pause.end_s and duty.start_s <= pause.start_s < duty.end_s:
                found.append((_exact(pause.start_s), PAUSE, duty, pause))
        follows = after is not None and after.start_s <= duty.end_s
        found.append((_exact(duty.end_s), END, duty, after if follows else None))
    return iter(sorted(found, key=lambda moment: moment[:2]))


def _exact(time_s: float) -> float:
    """As the engine rounds delays, but that the start of the run stays what it is."""
    return round(time_s * TICKS_PER_S) / TICKS_PER_S


def alarm(floor: Floor, one: Presence, delay_s: float, number: int, what: str, subject: object) -> None:
    """A report about somebody's calendar; those of one instant come after stations' and sources', in natural order."""
    rank = len(floor.stations) + len(floor.sources) + one.worker.rank
    floor.alarm(on_grid(delay_s), CALENDAR, rank, number, what, subject)
