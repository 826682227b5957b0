"""What each worker's body has gone through so far, for the rules that even it out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.humans import Human
from opsim.plan.evenness import evens_out

if TYPE_CHECKING:
    from opsim.ergonomics.shift.dose_rates import DoseRates


class Dose:
    """Of one worker: RULA x seconds, the mean of the task at hand times the seconds that he was at work on it.

    before : of all that is over; per_s, since_s, until_s : of what he is at, or was at last
    """

    __slots__ = ("_before", "_per_s", "_since_s", "_until_s", "_worker", "rates")

    def __init__(self, rates: DoseRates, worker: int):
        self.rates, self._worker = rates, worker
        self._before = self._per_s = self._since_s = self._until_s = 0.0

    def so_far(self, now: float) -> float:
        """Until now."""
        return self._before + self._per_s * (min(now, self._until_s) - self._since_s)

    def works(self, now: float, task: int, until_s: float) -> None:
        """He works on a task from now until then, if nothing comes between."""
        self._before = self.so_far(now)
        self._per_s, self._since_s, self._until_s = self.rates.per_s(self._worker, task), now, until_s

    def stops(self, now: float) -> None:
        """What he worked on is broken off."""
        self._before = self.so_far(now)
        self._since_s = self._until_s = now


def heaviest_first(floor: Floor, posts: Sequence[Sequence[int]], members: Sequence[int]) -> list[int]:
    """Numbers of posts, those first where a job adds most to a body, on the mean of the members; else as they stand."""

    def added(post: Sequence[int]) -> float:
        tasks = [task for station in post for task in floor.plan.stations[station].tasks]
        return sum(floor.plan.tasks[task].mean_s() * per_s(task) for task in tasks)

    def per_s(task: int) -> float:
        return sum(floor.doses[member].rates.per_s(member, task) for member in members) / len(members)

    strain = [added(post) for post in posts]
    return sorted(range(len(posts)), key=lambda post: (-strain[post], post))


def install(floor: Floor) -> None:
    """Doses are counted where a rule of the plan asks for them."""
    plan = floor.plan
    if not evens_out(plan):
        return
    from opsim.ergonomics.shift.dose_rates import dose_rates_of

    rates = dose_rates_of(plan, floor.draws.workforce)
    floor.doses = tuple(Dose(rates, worker.rank) for worker in floor.workers)
    if not floor.humans:
        floor.humans = tuple(Human(worker, on_posture=False) for worker in floor.workers)
        for worker, human in zip(floor.workers, floor.humans):
            worker.human = human
    for human, dose in zip(floor.humans, floor.doses):
        human.told.append(dose)
