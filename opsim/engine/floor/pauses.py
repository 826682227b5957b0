"""Breaks and meetings: on the way to where they are spent, and there."""

from __future__ import annotations

from opsim.engine.floor.machine import NOTHING, inlined, step
from opsim.engine.floor.parts.events import alarm
from opsim.engine.floor.parts.presence import Presence
from opsim.engine.floor.parts.rows import log_worker
from opsim.engine.floor.parts.state import Floor
from opsim.engine.floor.worker import be_busy, set_free, take_off, walk
from opsim.engine.rules import CALENDAR, duty
from opsim.log import BREAK, MEETING

_pause_lasts_s = inlined(duty.pause_lasts_s)


@step
def begin_pause(floor: Floor, one: Presence) -> None:
    """He is free, and the first of the pauses he is owed begins: with the walk to its place, where it has one."""
    worker, pause = one.worker, one.owed.pop(0)
    one.pause = pause
    lasts_s, rank = _pause_lasts_s(pause.start_s, pause.end_s), floor.n_stations + floor.n_sources + worker.rank
    event = alarm(floor, lasts_s, CALENDAR, rank, 1, floor.people.pause_over_line, one)
    event.other = pause
    if pause.place >= 0:
        metres = floor.distance_m[worker.place * floor.n_places + pause.place]
        if metres > 0:
            log_worker(floor, worker)
            be_busy(floor, worker)
            walk(floor, worker, pause.place, metres / worker.walk_m_per_s)
            return
        worker.place = pause.place
    rest(floor, one)


@step
def rest(floor: Floor, one: Presence) -> None:
    """He is where he spends it."""
    meeting = False
    if one.pause:
        meeting = one.pause.meeting == 1
    take_off(floor, one.worker, BREAK, MEETING if meeting else 0)


@step
def end_pause(floor: Floor, one: Presence) -> None:
    """He is free again, where he stands; or as soon as he has walked to where he wanted to spend it."""
    one.pause = NOTHING
    if one.worker.kind == BREAK:
        set_free(floor, one.worker)
