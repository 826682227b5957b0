"""Events to come: a binary heap by time, then by the order in which they were set; and time on the grid."""

from __future__ import annotations

import math

from opsim.engine.fast_engine.floor_state import Floor
from opsim.engine.fast_engine.machine import Array, address_of, fresh, give_back, inlined, words_at
from opsim.engine.fast_engine.machine.intrinsics import array_at, rounded
from opsim.engine.fast_engine.machine.intrinsics import lowest_bit as lowest_bit
from opsim.engine.fast_engine.machine.lists import give_bytes_back, take_bytes
from opsim.engine.fast_engine.state import Event, Worker
from opsim.engine.rules import COMPLETION

TICKS, STEP = 2.0**20, 2.0**-20
INF, NAN = math.inf, math.nan


@inlined
def on_grid(delay_s: float) -> float:
    """A delay rounded once to a multiple of 2^-20 s, at least one of them; products with powers of 2 are exact."""
    return max(1.0, rounded(delay_s * TICKS)) * STEP


@inlined
def on_grid_from_0(delay_s: float) -> float:
    """The same for what may be 0, or negative."""
    return rounded(delay_s * TICKS) * STEP


new_event = fresh(Event)
forget_event = give_back(Event)
as_floats, as_events = array_at("float"), array_at("Event")


@inlined
def _moved(floor: Floor, old: Array[int], room: int, larger: int) -> int:
    made = take_bytes(floor.memory, 8 * larger)
    new: Array[int] = words_at(made)
    for i in range(room):
        new[i] = old[i]
    if room:
        give_bytes_back(floor.memory, address_of(old), 8 * room)
    return made


@inlined
def _grow(floor: Floor) -> None:
    room = floor.heap_room
    larger = max(64, 2 * room)
    times, orders, events = floor.heap_time, floor.heap_order, floor.heap_event
    floor.heap_time = as_floats(_moved(floor, words_at(address_of(times)), room, larger))
    floor.heap_order = words_at(_moved(floor, orders, room, larger))
    floor.heap_event = as_events(_moved(floor, words_at(address_of(events)), room, larger))
    floor.heap_room = larger


@inlined
def is_last_of_instant(floor: Floor) -> bool:
    """Whether nothing else is to come at the time of the event that is at hand."""
    return floor.heap_n == 0 or floor.heap_time[0] > floor.env_now


@inlined
def push_event(floor: Floor, at_s: float, event: Event) -> None:
    """An event is to come at a time."""
    if floor.heap_n == floor.heap_room:
        _grow(floor)
    times, orders, events = floor.heap_time, floor.heap_order, floor.heap_event
    number = floor.n_events
    floor.n_events = number + 1
    i = floor.heap_n
    floor.heap_n = i + 1
    while i > 0:
        parent = (i - 1) >> 1
        if times[parent] <= at_s:
            break
        times[i] = times[parent]
        orders[i] = orders[parent]
        events[i] = events[parent]
        i = parent
    times[i] = at_s
    orders[i] = number
    events[i] = event


@inlined
def pop_event(floor: Floor) -> Event:
    """The next event, taken out. There must be one."""
    times, orders, events = floor.heap_time, floor.heap_order, floor.heap_event
    first = events[0]
    n = floor.heap_n - 1
    floor.heap_n = n
    at_s, number, last = times[n], orders[n], events[n]
    i = 0
    while True:
        child = 2 * i + 1
        if child >= n:
            break
        other = child + 1
        if other < n:
            sooner, tie = times[other] < times[child], times[other] == times[child]
            if sooner or (tie and orders[other] < orders[child]):
                child = other
        if times[child] > at_s or (times[child] == at_s and orders[child] > number):
            break
        times[i] = times[child]
        orders[i] = orders[child]
        events[i] = events[child]
        i = child
    times[i] = at_s
    orders[i] = number
    events[i] = last
    return first


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
        event: Event = new_event(floor)  # nothing follows: it stands where SimPy has an interruption of a process
        push_event(floor, floor.env_now, event)
