"""Rest by need: who is free and too tired takes a rest, until he is not, or has to go."""

from __future__ import annotations

import simpy

from opsim.engine.rules import CALENDAR
from opsim.engine.simpy_engine.floor import Floor, Handler, cancel
from opsim.engine.simpy_engine.presence import DUTY
from opsim.engine.simpy_engine.state import Worker
from opsim.engine.simpy_engine.worker import set_free, take_off
from opsim.log import BREAK, REST

REST_OVER = "a rest by need is over"


def install(floor: Floor) -> None:
    """Rests, where people take them; asked before those who send anybody."""
    plan = floor.plan.human
    if plan.rest is None or plan.fatigue is None:
        return
    rests = Rests(floor, plan.rest, plan.fatigue)
    floor.dispatchers.insert(0, rests.look)
    floor.dispatchers.append(rests.look)  # again: who is seen to stay on after his shift may be too tired
    for human in floor.humans:
        human.told.append(_Watched(rests, human.worker.rank))


class Rests:
    """worked : who has worked since he was looked at, or was called away from a rest

    resting : until when they rest, by rank
    """

    def __init__(self, floor: Floor, rest, model):
        self.rest, self.model, self.floor = rest, model, floor
        self.worked: set[int] = set()
        self.resting: dict[int, simpy.Event] = {}

    def look(self, floor: Floor) -> bool:
        """Who has to go rests no more; who has come free tired rests. True where something changed."""
        changed = False
        for rank in sorted(self.resting) if self.resting else ():
            if DUTY in floor.workers[rank].limits:
                self._over(floor, floor.workers[rank])
                self.worked.add(rank)  # and may be too tired still when he is back
                changed = True
        for rank in sorted(self.worked) if self.worked else ():
            worker = floor.workers[rank]
            if rank in floor.free and DUTY not in worker.limits:
                self.worked.discard(rank)
                changed |= self._look_at(floor, worker)
        return changed

    def over(self, floor: Floor, worker: Worker) -> None:
        """He is rested."""
        if worker.rank in self.resting:
            self._over(floor, worker)

    def _look_at(self, floor: Floor, worker: Worker) -> bool:
        human = worker.human
        if human.level(floor.now) <= self.rest.above:
            return False
        rest_s = self.model.rest_to_s(human.tired.state, self.rest.until)
        take_off(floor, worker, BREAK, REST)
        rank = len(floor.stations) + len(floor.sources) + worker.rank
        self.resting[worker.rank] = floor.alarm(rest_s, CALENDAR, rank, 3, REST_OVER, (self, worker))
        return True

    def _over(self, floor: Floor, worker: Worker) -> None:
        cancel(self.resting.pop(worker.rank))
        set_free(floor, worker)


class _Watched:
    """Notes who works: nobody else can have become too tired."""

    __slots__ = ("rank", "worked")

    def __init__(self, rests: Rests, rank: int):
        self.worked, self.rank = rests.worked, rank

    def works(self, _now: float, _task: int, _until_s: float) -> None:
        self.worked.add(self.rank)

    def stops(self, _now: float) -> None:
        """Nothing to note."""


HANDLERS: dict[str, Handler] = {REST_OVER: lambda floor, what: what[0].over(floor, what[1])}
