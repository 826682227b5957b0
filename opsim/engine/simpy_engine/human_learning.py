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
        experience = experience_of(floor.plan, human.worker.rank)
        if plan.forgetting is None:
            human.factors.append(_Learner(plan.learning.multiplier, experience))
            continue
        human.memory = Memory(plan.learning, plan.forgetting, experience, first_s)
        human.factors.append(_Forgetful(plan.learning.multiplier, human.memory))


class _Learner:
    """Each repetition is told how long it takes by how many were before."""

    __slots__ = ("experience", "multiplier")

    def __init__(self, multiplier, experience: tuple[float, ...]):
        self.multiplier, self.experience = multiplier, experience

    def __call__(self, _floor: Floor, _worker: Worker, _station: Station, task: int, k: int) -> float:
        return self.multiplier((self.experience[task] if self.experience else 0.0) + k + 1.0)


class _Forgetful:
    """Each repetition is told how long it takes by what is remembered of those before."""

    __slots__ = ("memory", "multiplier")

    def __init__(self, multiplier, memory: Memory):
        self.multiplier, self.memory = multiplier, memory

    def __call__(self, floor: Floor, _worker: Worker, _station: Station, task: int, k: int) -> float:
        return self.multiplier(self.memory.begins(task, k, floor.now))
