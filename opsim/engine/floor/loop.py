"""A floor on a SimPy environment: its events are told to it, and an instant is settled after the last of them."""

from __future__ import annotations

from collections.abc import Generator
from heapq import heappop, heappush
from typing import Any

import simpy

from opsim.engine.endless import endless_instant
from opsim.engine.floor.event_list import new_event
from opsim.engine.floor.settle import happen, settle

AFTER_EVERYTHING = 2
"""SimPy's priorities are 0 (urgent) and 1 (normal): settle comes after both."""


def prepare(_build: Any) -> None:
    """A floor that is set up needs nothing more to be driven by SimPy."""


class _AtEnd:
    """The event that settles an instant."""

    __slots__ = ("_defused", "callbacks")
    _ok, _value = True, None

    def __init__(self, call: Any):
        self.callbacks = [call]


def live_in(env: simpy.Environment, floor: Any) -> None:
    """From now on the floor's events are those of an environment."""

    def happens(event: Any) -> None:
        floor.env_now = env._now
        happen(floor, event)
        if floor.error:
            raise endless_instant(floor.plan, floor)

    def settles(_event: Any) -> None:
        floor.env_now = env._now
        settle(floor)
        if floor.error:
            raise endless_instant(floor.plan, floor)

    def settle_at_end() -> None:
        heappush(env._queue, (env._now, AFTER_EVERYTHING, next(env._eid), _AtEnd(settles)))  # type: ignore[arg-type, misc]

    floor.env, floor.happens, floor.settle_at_end = env, happens, settle_at_end


def working_life(floor: Any, worker: Any) -> Generator[Any, Any, None]:
    """The SimPy process of a worker: spend the stretch of time he was given, report it, wait for the next."""
    while True:
        event = worker.stretch_over
        try:
            yield event
        except simpy.Interrupt:  # the stretch means nothing any more; another event is in its place
            continue
        worker.stretch_over = new_event(floor)
        floor.happens(event)


def run_until(env: simpy.Environment, until_s: float) -> None:
    """Everything that happens before a time.

    NOTE: what ``env.run(until=...)`` does, with ``Environment.step`` written out: 5 % of a run.
    """
    queue = env._queue
    while queue and queue[0][0] < until_s:
        env._now, _, _, event = heappop(queue)
        callbacks, event.callbacks = event.callbacks, None  # type: ignore[assignment]
        for callback in callbacks:
            callback(event)
        if not event._ok and not hasattr(event, "_defused"):
            raise event._value
