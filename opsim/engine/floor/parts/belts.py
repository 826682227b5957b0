"""Conveyors: who rides where, and when there is room for one more. Positions are counted in seconds of travel."""

from __future__ import annotations

from opsim.engine.floor.machine import Call, List, inlined, struct
from opsim.engine.floor.parts.clock import INF
from opsim.engine.floor.parts.records import Event
from opsim.engine.floor.parts.state import Job, Station


@struct
class Belt:
    """See ``belts``. rank : where its reports come among those of an instant, as a station's

    rigid : whether it stands still as a whole; on_at_s : of each of its ``jobs``, how long it had moved when it got on
    get_on_line, get_off_line : steps told of a job that gets on, or off
    """

    station: Station
    rank: int
    travel_s: float
    headway_s: float
    capacity: int
    jobs: List[Job]
    waiting: List[Job]
    last_on_s: float
    last_off_s: float
    opens: Event
    rigid: int
    moved_s: float
    since_s: float
    on_at_s: List[float]
    stands: int
    halted: int
    get_on_line: Call
    get_off_line: Call


@inlined
def moved_at_s(belt: Belt, now: float) -> float:
    """How long it has moved."""
    return belt.moved_s if belt.stands else belt.moved_s + (now - belt.since_s)


@inlined
def rest_s(belt: Belt, at: int, way_s: float, now: float) -> float:
    """For how long it has to move until the job number ``at`` on it is so far from the beginning."""
    return way_s - (moved_at_s(belt, now) - belt.on_at_s[at])


@inlined
def until_open_s(belt: Belt, now: float) -> float:
    """How long it has to move until the next job may get on; inf where it is full."""
    n = len(belt.jobs)
    if n >= belt.capacity:
        return INF
    if belt.rigid:
        return rest_s(belt, n - 1, belt.headway_s, now) if n else 0.0
    opens_s = max(belt.last_on_s + belt.headway_s, belt.last_off_s + (n + 1) * belt.headway_s - belt.travel_s)
    return opens_s - now
