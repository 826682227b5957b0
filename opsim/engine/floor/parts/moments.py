"""Whether a worker is there, and all that changes in it, in the order in which it is applied."""

from __future__ import annotations

from collections.abc import Iterator

from opsim.clock import TICKS_PER_S
from opsim.plan.calendar import Duty, Pause

GONE, HERE, LEAVING, PAUSED = range(4)
"""LEAVING: he will go as soon as he may; PAUSED: in a pause, on the way to its place included."""
END, BEGIN, PAUSE = range(3)
"""What changes, in the order in which changes of one instant are applied."""
Moment = tuple[float, int, Duty, Pause | Duty | None]
"""(when, what, in which shift, which pause or, at the end of a shift, which shift follows at once)"""


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
