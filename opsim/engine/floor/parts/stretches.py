"""Stretches of time that workers spend, as their SimPy processes wait for them, and the end of an instant."""

from __future__ import annotations

from heapq import heappush
from typing import Any

from opsim.engine.floor.machine.structs import more_of
from opsim.engine.floor.parts.heap import new_event, push_event
from opsim.engine.floor.parts.state import Floor, Worker
from opsim.engine.rules import COMPLETION

NOBODYS = -1
"""The line of an event that nothing follows: it stands where SimPy has an interruption of a process."""


@more_of("Worker")
class WorkerInSimPy(Worker):
    """process : the SimPy process of a worker, if it has one; stretch_over : the event that it waits for

    name : as in the Plan
    """

    __slots__ = ("name", "process", "stretch_over")


@more_of("Floor")
class FloorInSimPy(Floor):
    """env : where it lives; draws : of the replication; log, write : its rows; rows : those to be packed at the end

    happens, settle_at_end : what its loop does with an event, and how it has an instant settled
    """

    __slots__ = ("draws", "env", "happens", "log", "plan", "rows", "settle_at_end", "write")


def wake(floor: Any) -> None:
    """Have this instant settled, once, after all its other events."""
    if not floor.settle_pending:
        floor.settle_pending = 1
        floor.settle_at_end()


def stretch(floor: Any, worker: Any, line: Any, delay_s: float) -> None:
    """The worker's stretch of time ends after a delay that is on the grid."""
    env = floor.env
    if worker.process is None:
        event = new_event(floor)
        event.callbacks.append(floor.happens)
    else:
        event = worker.stretch_over
    event.line, event.alive = line, 1
    event.kind, event.rank, event.number = COMPLETION, worker.rank, 0
    event.worker, event.version = worker, worker.version
    heappush(env._queue, (env._now + delay_s, 1, next(env._eid), event))


def end_stretch(floor: Any, worker: Any) -> None:
    """The stretch under way means nothing any more."""
    worker.version += 1
    process = worker.process
    if process is not None:
        worker.stretch_over = new_event(floor)
        if process is not floor.env.active_process:
            process.interrupt()
    elif floor.has_orders and worker is not floor.active:
        event = new_event(floor)
        event.line = NOBODYS
        push_event(floor, floor.env_now, event)
