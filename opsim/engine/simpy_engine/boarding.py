"""How jobs get on a conveyor: one after the other, as soon as there is room at its beginning."""

from collections.abc import Callable
from math import inf
from typing import Any

from opsim.engine.rules import COMPLETION
from opsim.engine.simpy_engine.belts import Belt
from opsim.engine.simpy_engine.floor import Floor, Handler, cancel
from opsim.engine.simpy_engine.state import Job, Station

OPENS = "conveyor opens"

Move = Callable[[Floor, Any, Job], None]


def hang(belt: Belt, get_on: Move, get_off: Move) -> None:
    """Jobs that come to the belt get on where there is room; who leaves it gets off, and makes room."""

    def receive(floor: Floor, _station: Station, job: Job) -> None:
        belt.waiting.append(job)
        let_on(floor, belt)

    def vacate(floor: Floor, _station: Station, job: Job) -> None:
        get_off(floor, belt, job)
        let_on(floor, belt)

    belt.get_on = get_on
    belt.station.receive, belt.station.vacate = receive, vacate


def let_on(floor: Floor, belt: Belt) -> None:
    """Who waits gets on where there is room; the station says whether there is room for somebody else."""
    while belt.waiting and belt.until_open_s(floor.now) <= 0:
        belt.get_on(floor, belt, belt.waiting.popleft())
    wait_s = belt.until_open_s(floor.now)
    belt.station.capacity = belt.plan.capacity if wait_s <= 0 and not belt.waiting else 0
    forget_opening(belt)
    if belt.moves and 0 < wait_s < inf:
        belt.opens = floor.alarm(wait_s, COMPLETION, rank_of(floor, belt), -1, OPENS, belt)


def forget_opening(belt: Belt) -> None:
    """The report of room that is to come means nothing any more."""
    if belt.opens is not None:
        cancel(belt.opens)
        belt.opens = None


def rank_of(floor: Floor, belt: Belt) -> int:
    """Where reports of the belt come among those of one instant: after those of workers, as a station's."""
    return len(floor.workers) + belt.station.rank


def _opens(floor: Floor, belt: Belt) -> None:
    belt.opens = None
    let_on(floor, belt)
    floor.stir(belt.station)


HANDLERS: dict[str, Handler] = {OPENS: _opens}
