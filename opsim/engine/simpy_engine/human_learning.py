"""Learning and forgetting on the floor: a factor of every time that a worker draws himself."""

from __future__ import annotations

from opsim.engine.simpy_engine.floor import Floor
from opsim.engine.simpy_engine.state import Station, Worker
from opsim.human.memory import Memory, experience_of, first_times


def install(floor: Floor) -> None:
    """A factor at every worker, where people learn."""
    plan = floor.plan.human
    if plan.learning is None:
        return
    first_s = first_times(floor.plan, plan.learning)
    for human in floor.humans:
        memory = Memory(plan.learning, plan.forgetting, experience_of(floor.plan, human.worker.rank), first_s)
        human.factors.append(_Learner(plan.learning.multiplier, memory))
        if plan.forgetting is not None:
            human.told.append(memory)


class _Learner:
    """Counts a worker's repetitions; each is told how long it takes by how many were before."""

    __slots__ = ("memory", "multiplier")

    def __init__(self, multiplier, memory: Memory):
        self.multiplier, self.memory = multiplier, memory

    def __call__(self, floor: Floor, _worker: Worker, _station: Station, task: int, _k: int) -> float:
        return self.multiplier(self.memory.begins(task, floor.now))
