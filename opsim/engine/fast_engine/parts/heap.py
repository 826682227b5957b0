"""Events to come: a binary heap by time, then by the order in which they were set."""

from __future__ import annotations

from opsim.engine.fast_engine.machine import Array, address_of, fresh, give_back, inlined, words_at
from opsim.engine.fast_engine.machine.memory import give_bytes_back, take_bytes
from opsim.engine.fast_engine.machine.structs import array_at
from opsim.engine.fast_engine.parts.records import Event
from opsim.engine.fast_engine.parts.state import Floor

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
