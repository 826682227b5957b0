"""Who has to go, who is back, who stays on: what is to be seen of people who have shifts in every instant."""

from __future__ import annotations

from opsim.engine.rules.duty import stays_on
from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.interruption import call_again
from opsim.engine.simpy_engine.leaving import Leaving
from opsim.engine.simpy_engine.overtime import Needs, Staff
from opsim.engine.simpy_engine.pauses import begin_pause, end_pause, rest
from opsim.engine.simpy_engine.presence import DUTY, GONE, HERE, LEAVING, PAUSED, Presence, moments
from opsim.engine.simpy_engine.state import Job, Station, Worker
from opsim.engine.simpy_engine.worker import set_free, take_off
from opsim.log import ABSENT, BREAK, OFF, REST, WALK
from opsim.plan import Duty, Pause

ORDER = 10
"""Among the ways to begin a task: before all others, since who has to go begins none."""


class Attendance:
    """of : the workers who have shifts, by rank; watched : those of them who are to be looked at when they are free."""

    def __init__(self, floor: Floor):
        self.leaving, self.needs = Leaving(floor), Needs(floor)
        on_shifts = [worker for worker in floor.workers if worker.plan.duties is not None]
        self.of = {worker.rank: Presence(worker, moments(worker.plan.duties or ())) for worker in on_shifts}
        self.watched: set[int] = set()
        floor.dispatchers.append(self.look)
        floor.left_station.append(self._left)
        for station in floor.stations:
            station.add_act(ORDER, self.act)

    def act(self, floor: Floor, job: Job, worker: Worker) -> bool:
        """Somebody is about to begin a task: he waits to carry, or has to go and does not begin it."""
        if self.leaving.ties.met(floor, job, worker):
            return True
        one = self.of.get(worker.rank)
        if one is None:
            return False
        if one.state != LEAVING or worker.staying is job:
            return False
        worker.since_s = floor.now  # what he did until now is written, or will be with the job
        set_free(floor, worker)
        call_again(floor, job)
        return True

    def look(self, floor: Floor) -> bool:
        """Whoever may go goes, who is back goes on, and who is to be relieved is; True where something changed."""
        changed = self._look_at_all(floor)
        reliefs, ties = self.leaving.reliefs, self.leaving.ties
        if reliefs.asked and reliefs.send(floor):
            self._look_at_all(floor)  # who was relieved at once goes, before the idle walk on or home
            changed = True
        if ties.left and ties.send(floor):
            changed = True
        return changed

    def be_here(self, one: Presence) -> None:
        """He need not go any more, and can be sent; but where a job waits for him, nowhere else."""
        worker = one.worker
        one.state, one.goes, worker.going, worker.staying = HERE, False, False, None
        self.leaving.reliefs.drop(worker)
        worker.restrict(DUTY, 0 if worker.rank in self.leaving.ties.job_of else None)
        self.watched.add(worker.rank)

    def leave(self, floor: Floor, one: Presence, *, goes: bool) -> None:
        """He has to go: now where he may, else as soon as he may."""
        worker = one.worker
        one.state, one.goes, worker.going = LEAVING, goes, goes
        one.overtime = one.undecided = False
        worker.restrict(DUTY, 0)
        self.watched.add(worker.rank)
        shift = floor.plan.shifts[one.shift_on.shift]
        worker.staying = self.leaving.leave(floor, worker, shift.at_end if goes else shift.at_break)
        if worker.rank in floor.free:
            self._go(floor, one)

    def pause_over(self, floor: Floor, one: Presence, pause: Pause) -> None:
        """He comes back, or has the next pause that he is owed."""
        if one.pause is not pause:
            return
        end_pause(floor, one)
        if one.owed:
            one.state = LEAVING
            self.watched.add(one.worker.rank)
        else:
            self.be_here(one)

    def overtime_over(self, floor: Floor, one: Presence, duty: Duty) -> None:
        """He goes, however much there is still to do."""
        if one.overtime and one.duty is duty:
            self.leave(floor, one, goes=True)

    def _look_at_all(self, floor: Floor) -> bool:
        changed = False
        for rank in sorted(self.watched) if self.watched else ():
            if self._look_at(floor, self.of[rank]):
                changed = True
        return changed

    def _look_at(self, floor: Floor, one: Presence) -> bool:
        """True where something became of him."""
        worker = one.worker
        if one.undecided:
            return self._decide(floor, one)
        if one.state == LEAVING:
            self.leaving.stand_by(floor, worker)
        if worker.rank not in floor.free:
            return one.overtime and self._rests_for_nobody(floor, one)
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
        if floor.stirred or self._is_needed(floor, one):
            return False
        self.leave(floor, one, goes=True)
        return True

    def _rests_for_nobody(self, floor: Floor, one: Presence) -> bool:
        """Who rests by need in overtime goes home instead, where nobody needs him; True where he does."""
        worker = one.worker
        if worker.kind != BREAK or worker.cause != REST or floor.stirred or self._is_needed(floor, one):
            return False
        self.leave(floor, one, goes=True)
        return True

    def _decide(self, floor: Floor, one: Presence) -> bool:
        """At the end of his shift: he stays, or has to go; which is seen when all jobs are in that come in now."""
        if floor.stirred:
            return False
        one.undecided = False
        most_s = floor.plan.shifts[one.shift_on.shift].overtime_s
        if stays_on(self._is_needed(floor, one), most_s):
            self.be_here(one)
        else:
            self.leave(floor, one, goes=True)
        return True

    def _is_needed(self, floor: Floor, one: Presence) -> bool:
        """Whether too few of those whose shift it is can do what is left for him to do before his overtime is over."""
        duty = one.shift_on
        until_s = duty.end_s + floor.plan.shifts[duty.shift].overtime_s
        ties = self.leaving.ties
        there = [worker for worker in floor.workers if worker is not one.worker and not self._is_gone(worker.rank)]
        on_duty = [worker for worker in there if worker.rank not in self.of or not self.of[worker.rank].overtime]
        jobs_of_gone = {job for rank, job in ties.job_of.items() if self._is_gone(rank)}
        return self.needs.need(floor, one.worker, Staff(on_duty, there, jobs_of_gone), until_s, ties)

    def _left(self, _floor: Floor, job: Job, _station: Station) -> None:
        """Who stayed for a job's tasks at a station is done there as the job leaves it."""
        for rank in self.watched:
            worker = self.of[rank].worker
            if worker.staying is job:
                worker.staying = None

    def _is_gone(self, rank: int) -> bool:
        """Whether somebody is off or absent, or as good as that."""
        other = self.of.get(rank)
        return other is not None and (other.state == GONE or other.goes)

    def _go(self, floor: Floor, one: Presence) -> None:
        """He is free, and goes: off, or to the pause that he is owed."""
        worker = one.worker
        self.leaving.reliefs.drop(worker)
        worker.staying = None
        if one.goes:
            one.state, one.duty, one.goes, worker.going = GONE, None, False, False
            take_off(floor, worker, ABSENT if one.misses else OFF)
            self.leaving.ties.goes_off(floor, worker)
            if one.misses:
                self.leaving.ties.release(floor, worker)
        else:
            one.state = PAUSED
            begin_pause(floor, self, one)
        if worker.kind != WALK:
            self.watched.discard(worker.rank)
