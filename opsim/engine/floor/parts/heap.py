"""Events to come: those of a SimPy environment."""

from __future__ import annotations

from heapq import heappush
from typing import Any

from opsim.engine.floor.machine import give_back
from opsim.engine.floor.parts.records import Event

forget_event = give_back(Event)


class Coming(Event):
    """An event of a floor with what SimPy asks of one. It is told to the floor, or to a worker's process."""

    __slots__ = ("_defused", "callbacks")
    _ok, _value = True, None

    def __init__(self) -> None:
        super().__init__()
        self.callbacks: list[Any] = []


def new_event(_floor: Any) -> Coming:
    """An event that nobody waits for yet."""
    return Coming()


def is_last_of_instant(floor: Any) -> bool:
    """Whether nothing else is to come at the time of the event that is at hand."""
    queue = floor.env._queue
    return not queue or queue[0][0] > floor.env._now


def push_event(floor: Any, at_s: float, event: Any) -> None:
    """An event is to come at a time, and the floor is told.

    NOTE: what ``Environment.schedule`` does, for an instant that is known to the bit.
    """
    env = floor.env
    event.callbacks.append(floor.happens)
    heappush(env._queue, (at_s, 1, next(env._eid), event))
