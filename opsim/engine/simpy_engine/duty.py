"""Shifts, breaks, meetings, absence: when people come and when they have to go, by their calendars."""

from __future__ import annotations

from opsim.engine.rules.duty import is_absent
from opsim.engine.simpy_engine.attendance import Attendance
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.pauses import PAUSE_OVER, end_pause
from opsim.engine.simpy_engine.presence import BEGIN, DUTY, GONE, HERE, LEAVING, PAUSED, Presence, alarm
from opsim.engine.simpy_engine.state import Worker
from opsim.engine.simpy_engine.worker import log_worker, set_free, take_off
from opsim.log import ABSENT, OFF
from opsim.plan import Duty, Pause

CALENDAR_TURNS = "a shift or a pause of a worker begins or ends"
OVERTIME_OVER = "overtime of a worker is over"


class Calendars:
    """people : those who have one."""

    def __init__(self, floor: Floor):
        self.people = Attendance(floor)
        for one in self.people.of.values():
            take_off(floor, one.worker, OFF)
            one.due = next(one.to_come, None)
            self.turn(floor, one)

    def turn(self, floor: Floor, one: Presence) -> None:
        """Apply what is due of somebody's calendar, and wait for the next of it."""
        while one.due is not None and one.due[0] <= floor.now:
            _, what, duty, other = one.due
            if what == BEGIN:
                self._begin(floor, one, duty)
            elif isinstance(other, Pause):
                self._owe(floor, one, duty, other)
            else:
                self._end(floor, one, duty, other)
            one.due = next(one.to_come, None)
        if one.due is not None:
            alarm(floor, one, one.due[0] - floor.now, 0, CALENDAR_TURNS, (self, one))

    def _begin(self, floor: Floor, one: Presence, duty: Duty) -> None:
        """His shift begins. Who is still there from the one before goes on, and is not absent; unless he goes since he
        misses this one, which has followed at once.
        """
        if one.misses and one.state == LEAVING:
            return
        worker, one.duty, one.overtime, one.undecided = one.worker, duty, False, False
        if one.state == GONE and self._misses(floor, worker, duty):
            _be_away(floor, worker, ABSENT)
            self.people.leaving.ties.release(floor, worker)
        elif one.state == GONE:
            set_free(floor, worker)
            worker.place, worker.round = worker.plan.place, -1
            self.people.be_here(one)
        elif one.state == LEAVING:
            self.people.be_here(one)

    def _end(self, floor: Floor, one: Presence, duty: Duty, follows: Duty | None) -> None:
        """His shift is over. Where another one follows at once, he goes only if he misses that."""
        worker = one.worker
        one.owed.clear()
        missed, one.misses = one.misses, follows is not None and self._misses(floor, worker, follows)
        if one.state == GONE:
            _be_away(floor, worker, OFF)
        elif follows is not None and not one.misses:
            if one.state == LEAVING:
                self.people.be_here(one)
        elif not missed:
            if one.state == PAUSED:
                end_pause(floor, one)
            self.people.be_here(one)
            most_s = floor.plan.shifts[duty.shift].overtime_s
            if most_s > 0:  # whether he stays is seen when all who come at this instant are there
                one.overtime = one.undecided = True
                worker.restrict(DUTY, 0)
                alarm(floor, one, most_s, 2, OVERTIME_OVER, (self.people, one, duty))
            else:
                self.people.leave(floor, one, goes=True)

    def _owe(self, floor: Floor, one: Presence, duty: Duty, pause: Pause) -> None:
        """A pause begins: at once, or after the one before, or when he is done."""
        if one.state == GONE or one.duty is not duty:
            return
        one.owed.append(pause)
        if one.state == HERE:
            self.people.leave(floor, one, goes=False)

    def _misses(self, floor: Floor, worker: Worker, duty: Duty) -> bool:
        share = worker.plan.absence
        return share > 0 and is_absent(floor.draws.chance(("absence", worker.plan.name), duty.number), share)


def _be_away(floor: Floor, worker: Worker, kind: int) -> None:
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = kind, 0, floor.now


def install(floor: Floor) -> None:
    """The calendars of people, where somebody has one; after the blocks that set people free."""
    if any(worker.plan.duties is not None for worker in floor.workers):
        Calendars(floor)


HANDLERS: dict[str, Handler] = {
    CALENDAR_TURNS: lambda floor, what: what[0].turn(floor, what[1]),
    PAUSE_OVER: lambda floor, what: what[0].pause_over(floor, *what[1:]),
    OVERTIME_OVER: lambda floor, what: what[0].overtime_over(floor, *what[1:]),
}
