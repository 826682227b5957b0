"""Shifts, breaks, meetings, absence and overtime: when workers are there, and when they have to go."""

from __future__ import annotations

from opsim.engine.rules.duty import is_absent, stays_on
from opsim.engine.simpy_engine.floor import Floor, Handler
from opsim.engine.simpy_engine.interruption import call_again
from opsim.engine.simpy_engine.leaving import Leaving
from opsim.engine.simpy_engine.overtime import Needs
from opsim.engine.simpy_engine.pauses import PAUSE_OVER, begin_pause, end_pause, rest
from opsim.engine.simpy_engine.presence import BEGIN, END, GONE, HERE, LEAVING, PAUSED, Presence, alarm, moments
from opsim.engine.simpy_engine.state import Job, Worker
from opsim.engine.simpy_engine.worker import log_worker, set_free, take_off
from opsim.log import ABSENT, OFF, WALK
from opsim.plan import Duty, Pause

CALENDAR_TURNS = "a shift or a pause of a worker begins or ends"
OVERTIME_OVER = "overtime of a worker is over"
ORDER = 10
"""Among the ways to begin a task: before all others, since who has to go begins none."""
DUTY = "duty"
"""What restricts somebody who is about to go, or is back for a job that waits for him: he is sent nowhere else."""


class Duties:
    """of : the workers who have shifts, by rank; watched : those of them who are to be looked at when they are free."""

    def __init__(self, floor: Floor):
        self.leaving, self.needs = Leaving(floor), Needs(floor)
        on_shifts = [worker for worker in floor.workers if worker.plan.duties is not None]
        self.of = {worker.rank: Presence(worker, moments(worker.plan.duties or ())) for worker in on_shifts}
        self.watched: set[int] = set()
        floor.dispatchers.append(self.look)
        for station in floor.stations:
            station.add_act(ORDER, self.act)
        for one in self.of.values():
            take_off(floor, one.worker, OFF)
            one.due = next(one.to_come, None)
            self.turn(floor, one)

    def turn(self, floor: Floor, one: Presence) -> None:
        """Apply what is due of somebody's calendar, and wait for the next of it."""
        while one.due is not None and one.due[0] <= floor.now:
            _, what, duty, other = one.due
            if what == BEGIN:
                self._begin(floor, one, duty)
            elif what == END:
                self._end(floor, one, duty, other)  # type: ignore[arg-type]
            else:
                self._owe(floor, one, duty, other)  # type: ignore[arg-type]
            one.due = next(one.to_come, None)
        if one.due is not None:
            alarm(floor, one, one.due[0] - floor.now, 0, CALENDAR_TURNS, (self, one))

    def act(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody is about to begin a task: he takes over, or waits to carry, or has to go and does not begin it."""
        if self.leaving.reliefs.met(floor, job, worker):
            return True
        one = self.of.get(worker.rank)
        if one is None:
            return False
        if self.leaving.ties.met(floor, job, worker):
            return True
        if one.state != LEAVING or one.staying is job:
            return False
        set_free(floor, worker)
        call_again(floor, job)
        return True

    def look(self, floor: Floor) -> bool:
        """Whoever may go goes, who is back goes on, and who is to be relieved is; True where something changed."""
        changed = False
        for rank in sorted(self.watched) if self.watched else ():
            if self._look_at(floor, self.of[rank]):
                changed = True
        reliefs = self.leaving.reliefs
        if reliefs.asked and reliefs.send(floor):
            changed = True
        return changed

    def pause_over(self, floor: Floor, one: Presence, pause: Pause) -> None:
        """He comes back, or has the next pause that he is owed."""
        if one.pause is not pause:
            return
        end_pause(floor, one)
        if one.owed:
            one.state = LEAVING
            self.watched.add(one.worker.rank)
        else:
            self._be_here(one)

    def overtime_over(self, floor: Floor, one: Presence, duty: Duty) -> None:
        """He goes, however much there is still to do."""
        if one.overtime and one.duty is duty:
            self._leave(floor, one, goes=True)

    def _look_at(self, floor: Floor, one: Presence) -> bool:
        """True where something became of him."""
        worker = one.worker
        if one.state == LEAVING:
            self.leaving.stand_by(floor, worker)
        if worker.rank not in floor.free:
            return False
        if one.state == LEAVING:
            self._go(floor, one)
        elif one.state == PAUSED:
            self.watched.discard(worker.rank)
            rest(floor, one)
        else:
            return self._set_to_work(floor, one)
        return True

    def _set_to_work(self, floor: Floor, one: Presence) -> bool:
        """He is free, and there: back to the job that waits for him, or to whatever comes; False where he stays on."""
        worker = one.worker
        if not one.overtime:
            self.watched.discard(worker.rank)
        worker.restrict(DUTY, None)
        if self.leaving.ties.go_back(floor, worker) or not one.overtime:
            return True
        if self.needs.need(floor, worker):
            return False
        self._leave(floor, one, goes=True)
        return True

    def _begin(self, floor: Floor, one: Presence, duty: Duty) -> None:
        """His shift begins. Who is still there from the one before goes on, and is not absent."""
        worker, one.duty, one.overtime = one.worker, duty, False
        if one.state == GONE and self._misses(floor, worker, duty):
            _be_away(floor, worker, ABSENT)
            self.leaving.ties.release(floor, worker)
        elif one.state == GONE:
            set_free(floor, worker)
            worker.place, worker.round = worker.plan.place, -1
            self._be_here(one)
        elif one.state == LEAVING:
            self._be_here(one)

    def _be_here(self, one: Presence) -> None:
        """He need not go any more, and can be sent; but where a job waits for him, nowhere else."""
        worker = one.worker
        one.state, one.goes, worker.going, one.staying = HERE, False, False, None
        self.leaving.reliefs.drop(worker)
        worker.restrict(DUTY, 0 if worker.rank in self.leaving.ties.job_of else None)
        self.watched.add(worker.rank)

    def _misses(self, floor: Floor, worker: Worker, duty: Duty) -> bool:
        share = worker.plan.absence
        return share > 0 and is_absent(floor.draws.chance(("absence", worker.plan.name), duty.number), share)

    def _owe(self, floor: Floor, one: Presence, duty: Duty, pause: Pause) -> None:
        """A pause begins: at once, or after the one before, or when he is done."""
        if one.state == GONE or one.duty is not duty:
            return
        one.owed.append(pause)
        if one.state == HERE:
            self._leave(floor, one, goes=False)

    def _end(self, floor: Floor, one: Presence, duty: Duty, follows: Duty | None) -> None:
        """His shift is over. Where another one follows at once, he goes only if he misses that."""
        worker = one.worker
        one.owed.clear()
        if one.state == GONE:
            _be_away(floor, worker, OFF)
        elif follows is not None and not self._misses(floor, worker, follows):
            if one.state == LEAVING:
                self._be_here(one)
        elif one.state == PAUSED:
            end_pause(floor, one)
            self._leave(floor, one, goes=True)
        else:
            self._be_here(one)
            most_s = floor.plan.shifts[duty.shift].overtime_s
            one.overtime = stays_on(most_s > 0 and self.needs.need(floor, worker), most_s)
            if one.overtime:
                alarm(floor, one, most_s, 2, OVERTIME_OVER, (self, one, duty))
            else:
                self._leave(floor, one, goes=True)

    def _leave(self, floor: Floor, one: Presence, *, goes: bool) -> None:
        """He has to go: now where he may, else as soon as he may."""
        worker = one.worker
        one.state, one.goes, worker.going, one.overtime = LEAVING, goes, goes, False
        worker.restrict(DUTY, 0)
        self.watched.add(worker.rank)
        shift = floor.plan.shifts[one.duty.shift]  # type: ignore[union-attr]
        one.staying = self.leaving.leave(floor, worker, shift.at_end if goes else shift.at_break)
        if worker.rank in floor.free:
            self._go(floor, one)

    def _go(self, floor: Floor, one: Presence) -> None:
        """He is free, and goes: off, or to the pause that he is owed."""
        worker = one.worker
        self.leaving.reliefs.drop(worker)
        one.staying = None
        if one.goes:
            one.state, one.duty, one.goes, worker.going = GONE, None, False, False
            take_off(floor, worker, OFF)
        else:
            one.state = PAUSED
            begin_pause(floor, self, one)
        if worker.kind != WALK:
            self.watched.discard(worker.rank)


def _be_away(floor: Floor, worker: Worker, kind: int) -> None:
    log_worker(floor, worker)
    worker.kind, worker.cause, worker.since_s = kind, 0, floor.now


def install(floor: Floor) -> None:
    """The calendars of people, where somebody has one. After all other blocks: who may go, goes in their wake."""
    if any(worker.plan.duties is not None for worker in floor.workers):
        Duties(floor)


HANDLERS: dict[str, Handler] = {
    CALENDAR_TURNS: lambda floor, what: what[0].turn(floor, what[1]),
    PAUSE_OVER: lambda floor, what: what[0].pause_over(floor, *what[1:]),
    OVERTIME_OVER: lambda floor, what: what[0].overtime_over(floor, *what[1:]),
}
