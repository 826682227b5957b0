"""Stretches of time that workers spend, and the end of an instant: what SimPy has its own form of."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import inlined
from opsim.engine.fast_engine.parts.heap import new_event, push_event
from opsim.engine.fast_engine.parts.records import Event
from opsim.engine.fast_engine.parts.state import Floor, Worker
from opsim.engine.rules import COMPLETION

NOBODYS = -1
"""The line of an event that nothing follows: it stands where SimPy has an interruption of a process."""


@inlined
def wake(floor: Floor) -> None:
    """Have this instant settled, once, after all its other events."""
    floor.settle_pending = 1


@inlined
def stretch(floor: Floor, worker: Worker, line: int, delay_s: float) -> None:
    """The worker's stretch of time ends after a delay that is on the grid."""
    event: Event = new_event(floor)
    event.line, event.alive = line, 1
    event.kind, event.rank, event.number = COMPLETION, worker.rank, 0
    event.worker, event.version = worker, worker.version
    push_event(floor, floor.env_now + delay_s, event)


@inlined
def end_stretch(floor: Floor, worker: Worker) -> None:
    """The stretch under way means nothing any more."""
    worker.version += 1
    if floor.has_orders and worker is not floor.active:
        event: Event = new_event(floor)
        event.line = NOBODYS
        push_event(floor, floor.env_now, event)
