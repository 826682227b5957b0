"""A floor's own clock inside somebody's SimPy environment: each of its instants comes when its time comes there."""

from __future__ import annotations

from collections.abc import Callable
from heapq import heappush
from math import inf, nextafter

import simpy

from opsim.clock import TICKS_PER_S
from opsim.engine.floor.loop import AFTER_EVERYTHING, run_until


class _Instant:
    """The event of the outer environment by which an instant of the own one comes."""

    __slots__ = ("_defused", "at_s", "callbacks")
    _ok, _value = True, None

    def __init__(self, at_s: float, call: Callable[[_Instant], None]):
        self.at_s, self.callbacks = at_s, [call]


class Inside:
    """Runs an environment of its own, ``own``, inside another, ``outer``, from the outer clock's time on until its end.

    An instant comes after everything else that the outer environment has at that time.
    start_s : the outer clock's time at which the own clock is at 0
    over    : called once, as the own clock comes to ``horizon_s``
    """

    def __init__(self, outer: simpy.Environment, horizon_s: float, over: Callable[[], None]):
        self.own, self.outer, self.start_s, self.horizon_s = simpy.Environment(), outer, float(outer.now), horizon_s
        self.failed = False
        self._over, self._planned = over, set[float]()

    @property
    def now_s(self) -> float:
        """The own clock, on the grid of time; where it failed, or at the horizon, it stands still."""
        last_s = self.own.now
        if self.failed:
            return last_s
        passed_s = round((self.outer.now - self.start_s) * TICKS_PER_S) / TICKS_PER_S
        return min(max(last_s, passed_s), self.horizon_s)

    def outer_s(self, own_s: float) -> float:
        """What the outer clock shows at a time of the own one."""
        return self.start_s + own_s

    def look_ahead(self) -> None:
        """Have the next instant come, or the horizon, unless that is planned already.

        NOTE: as ``Environment.schedule`` does it, for a time that is known to the bit.
        """
        queue = self.own._queue
        at_s = queue[0][0] if queue else inf
        if at_s >= self.horizon_s:
            at_s = self.horizon_s
        if at_s in self._planned:
            return
        self._planned.add(at_s)
        due_s, event = max(self.start_s + at_s, self.outer.now), _Instant(at_s, self._comes)
        heappush(self.outer._queue, (due_s, AFTER_EVERYTHING, next(self.outer._eid), event))  # type: ignore[arg-type, misc]

    def _comes(self, event: _Instant) -> None:
        at_s = event.at_s
        self._planned.discard(at_s)
        if self.failed:
            return
        if at_s >= self.horizon_s:
            self._over()
            return
        try:
            run_until(self.own, nextafter(at_s, inf))
        except BaseException:
            self.failed = True
            raise
        self.look_ahead()
