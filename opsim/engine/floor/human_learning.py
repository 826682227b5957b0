"""Learning and forgetting on the floor: a factor of every time that a worker draws himself."""

from __future__ import annotations

from math import nan
from typing import Any

from opsim.engine.floor.human_memory import begins
from opsim.engine.floor.machine import step
from opsim.engine.floor.parts.curves import multiplier_of
from opsim.engine.floor.parts.state import Floor, Station, Worker
from opsim.human.memory import experience_of, first_times


def install(build: Any, effects: Any) -> None:
    """A factor at every worker, where people learn."""
    plan, n_tasks = build.plan.human, len(build.tasks)
    if plan.learning is None:
        return
    for worker in build.workers:
        worker.human.units = build.floats(experience_of(build.plan, worker.rank) or [0.0] * n_tasks)
    if plan.forgetting is None:
        build.hang(effects.factors, learned)
        return
    effects.forgets = 1
    first_s = first_times(build.plan, plan.learning)
    effects.first_s = build.floats(first_s(task) for task in range(n_tasks))
    for worker in build.workers:
        worker.human.last_s = build.floats([nan] * n_tasks)
    build.hang(effects.factors, remembered)


@step
def learned(floor: Floor, worker: Worker, station: Station) -> None:
    """Each repetition is told how long it takes by how many were before."""
    human = worker.human
    before = human.units[floor.asked_task]
    human.effects.answer = multiplier_of(human.effects.learning, before + floor.asked_k + 1.0)


@step
def remembered(floor: Floor, worker: Worker, station: Station) -> None:
    """Each repetition is told how long it takes by what is remembered of those before."""
    human = worker.human
    n = begins(floor, human, floor.asked_task, floor.asked_k)
    human.effects.answer = multiplier_of(human.effects.learning, n)
