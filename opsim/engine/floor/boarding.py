"""How jobs get on a conveyor: one after the other, as soon as there is room at its beginning."""

from __future__ import annotations

from typing import Any

from opsim.engine.floor.machine import NOTHING, Handle, cast, inlined, line_of, step
from opsim.engine.floor.parts.belts import Belt, until_open_s
from opsim.engine.floor.parts.clock import INF
from opsim.engine.floor.parts.events import alarm, cancel, stir
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.state import Floor, Job, Station
from opsim.engine.rules import COMPLETION

_as_belt = cast(Belt)


@step
def receive(floor: Floor, station: Station, job: Job) -> None:
    """A job has come to the belt, and gets on where there is room."""
    station.belt.waiting.append(job)
    let_on(floor, station.belt)


@step
def vacate(floor: Floor, station: Station, job: Job) -> None:
    """A job leaves the belt: it gets off, and makes room."""
    station.belt.get_off_line(floor, station.belt, job)
    let_on(floor, station.belt)


@step
def let_on(floor: Floor, belt: Belt) -> None:
    """Who waits gets on where there is room; the station says whether there is room for somebody else."""
    while len(belt.waiting) > 0 and until_open_s(belt, floor.now) <= 0:
        belt.get_on_line(floor, belt, belt.waiting.pop(0))
    wait_s = until_open_s(belt, floor.now)
    belt.station.capacity = float(belt.capacity) if wait_s <= 0 and len(belt.waiting) == 0 else 0.0
    forget_opening(floor, belt)
    if _moves(belt) and 0 < wait_s < INF:
        belt.opens = alarm(floor, wait_s, COMPLETION, belt.rank, -1, line_of_opens, belt)


@inlined
def _moves(belt: Belt) -> bool:
    """Whether its room for the next job comes with time."""
    return not belt.rigid or not belt.stands


@step
def forget_opening(floor: Floor, belt: Belt) -> None:
    """The report of room that is to come means nothing any more."""
    if belt.opens:
        cancel(belt.opens)
        belt.opens = NOTHING


@step
def opens(floor: Floor, event: Event) -> None:
    """There is room for one more."""
    belt: Belt = _as_belt(event.subject)
    belt.opens = NOTHING
    let_on(floor, belt)
    stir(floor, belt.station)


line_of_opens = line_of(opens)


def hang(build: Any, belt: Handle, get_on: Any, get_off: Any) -> None:
    """Jobs that come to the belt get on where there is room; who leaves it gets off, and makes room."""
    build.line(opens)
    belt.get_on_line, belt.get_off_line = build.line(get_on), build.line(get_off)
    station = belt.station
    station.belt = belt
    station.receive, station.vacate = build.hook(receive), build.hook(vacate)
