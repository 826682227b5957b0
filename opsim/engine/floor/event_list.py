"""Events to come: those of a SimPy environment; the stretches of time that workers spend; and time on the grid."""

from __future__ import annotations

from heapq import heappush
from math import inf, nan
from typing import Any

from opsim.clock import on_grid as on_grid
from opsim.engine.floor.floor_state import Floor
from opsim.engine.floor.machine import give_back, more_of
from opsim.engine.floor.state import Event, Worker
from opsim.engine.rules import COMPLETION

TICKS, STEP = 2.0**20, 2.0**-20
INF, NAN = inf, nan
forget_event = give_back(Event)


def rounded(number: float) -> float:
    """To the nearest whole number, halves to the even one."""
    return float(round(number))


def on_grid_from_0(delay_s: float) -> float:
    """``on_grid`` for what may be 0, or negative."""
    return round(delay_s * TICKS) * STEP


def lowest_bit(bits: int) -> int:
    """The number of the lowest bit that is set; of 0: 64."""
    return (bits & -bits).bit_length() - 1 if bits else 64


class Coming(Event):
    """An event of a floor with what SimPy asks of one. It is told to the floor, or to a worker's process."""

    __slots__ = ("_defused", "callbacks")
    _ok, _value = True, None
    callbacks: Any


def new_event(_floor: Any) -> Coming:
    """An event of the floor, which is told of it once it is pushed."""
    return Coming()


def awaited_event() -> Coming:
    """An event that processes wait for."""
    event = Coming()
    event.callbacks = []
    return event


def is_last_of_instant(floor: Any) -> bool:
    """Whether nothing else is to come at the time of the event that is at hand."""
    queue = floor.env._queue
    return not queue or queue[0][0] > floor.env._now


def push_event(floor: Any, at_s: float, event: Any) -> None:
    """An event is to come at a time, and the floor is told.

    NOTE: what ``Environment.schedule`` does, for an instant that is known to the bit.
    """
    env = floor.env
    event.callbacks = floor.told
    heappush(env._queue, (at_s, 1, next(env._eid), event))


@more_of("Worker")
class WorkerInSimPy(Worker):
    """process : the SimPy process of a worker, if it has one; stretch_over : the event that it waits for

    name : as in the Plan
    """

    __slots__ = ("name", "process", "stretch_over")


@more_of("Floor")
class FloorInSimPy(Floor):
    """env : where it lives; draws : of the replication; log, write : its rows; rows : those to be packed at the end

    told : what its loop calls with an event; settle_at_end : how it has an instant settled
    """

    __slots__ = ("draws", "env", "log", "plan", "rows", "settle_at_end", "told", "write")


def wake(floor: Any) -> None:
    """Have this instant settled, once, after all its other events."""
    if not floor.settle_pending:
        floor.settle_pending = 1
        floor.settle_at_end()


def stretch(floor: Any, worker: Any, line: Any, delay_s: float) -> None:
    """The worker's stretch of time ends after a delay that is on the grid."""
    env = floor.env
    if worker.process is None:
        event = Coming()
        event.callbacks = floor.told
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
        worker.stretch_over = awaited_event()
        if process is not floor.env.active_process:
            process.interrupt()
    elif floor.has_orders and worker is not floor.active:
        push_event(floor, floor.env_now, new_event(floor))  # nothing follows, where SimPy has an interruption
