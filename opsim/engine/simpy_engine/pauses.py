"""Breaks and meetings: on the way to where they are spent, and there."""

from opsim.engine.rules.duty import pause_lasts_s
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.presence import Presence, alarm
from opsim.engine.simpy_engine.worker import log_worker, set_free, take_off, walk
from opsim.log import BREAK, MEETING

PAUSE_OVER = "a pause of a worker is over"


def begin_pause(floor: Floor, people: object, one: Presence) -> None:
    """He is free, and the first of the pauses he is owed begins: with the walk to its place, where it has one."""
    worker, pause = one.worker, one.owed.popleft()
    one.pause = pause
    alarm(floor, one, pause_lasts_s(pause.start_s, pause.end_s), 1, PAUSE_OVER, (people, one, pause))
    if pause.place >= 0:
        metres = floor.plan.distance_m[worker.place][pause.place]
        if metres > 0:
            log_worker(floor, worker)
            del floor.free[worker.rank]
            walk(floor, worker, pause.place, metres / worker.plan.walk_m_per_s)
            return
        worker.place = pause.place
    rest(floor, one)


def rest(floor: Floor, one: Presence) -> None:
    """He is where he spends it."""
    meeting = one.pause is not None and one.pause.meeting
    take_off(floor, one.worker, BREAK, MEETING if meeting else 0)


def end_pause(floor: Floor, one: Presence) -> None:
    """He is free again, where he stands; or as soon as he has walked to where he wanted to spend it."""
    one.pause = None
    if one.worker.kind == BREAK:
        set_free(floor, one.worker)
