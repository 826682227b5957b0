"""Reports after a delay, and events that mean nothing any more."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import Call, inlined
from opsim.engine.floor.parts.clock import on_grid
from opsim.engine.floor.parts.heap import new_event, push_event
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.state import Floor, Gate, Station


@inlined
def alarm(floor: Floor, delay_s: float, kind: int, rank: int, number: int, line: Call, subject: Any) -> Event:
    """A report after a delay, which is rounded to the grid. ``cancel`` makes it nothing."""
    event: Event = new_event(floor)
    event.line, event.alive = line, 1
    event.kind, event.rank, event.number = kind, rank, number
    event.subject = subject
    push_event(floor, floor.env_now + on_grid(delay_s), event)
    return event


@inlined
def cancel(event: Event) -> None:
    """An event that is to come will mean nothing. Nobody may refer to it after this."""
    event.alive = 0


@inlined
def stir_gate(floor: Floor, gate: Gate) -> None:
    """Whoever claims a place by a gate is looked at again."""
    if not gate.stirred:
        gate.stirred = 1
        floor.stirred.append(gate)


@inlined
def stir(floor: Floor, station: Station) -> None:
    """There may be room at a station: whoever wants in is looked at again."""
    for i in range(station.n_wanted_by):
        gate = station.wanted_by[i]
        if gate.claims:
            stir_gate(floor, gate)
